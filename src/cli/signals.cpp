#include "signals.h"

#include <csignal>

namespace kinetome::cli {
namespace {

constexpr int stopping_signals[] = {SIGTERM, SIGINT, SIGUSR1};

// A signal handler can reach nothing else: the one flag of the process.
std::atomic<bool> stop_requested{false};

extern "C" void request_stop(int) {
    stop_requested = true;
}

}  // namespace

StopToken watch_signals() {
    struct sigaction action = {};
    action.sa_handler = request_stop;
    action.sa_flags = SA_RESETHAND;
    for (const int signal : stopping_signals) sigaction(signal, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is reported like a full disk
    return StopToken(stop_requested);
}

void stop_watching_signals() {
    for (const int signal : stopping_signals) std::signal(signal, SIG_DFL);
}

}  // namespace kinetome::cli
