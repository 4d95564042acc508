// Runs a program, and keeps what it wrote and how it ended.
#pragma once

#include <fcntl.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

struct Command {
    std::vector<std::string> words;         ///< program and arguments; no shell sees them
    std::filesystem::path folder = {};      ///< to run in; empty: that of the test
    double time_limit = 120;                ///< seconds; then it is killed and the test fails
    std::optional<rlim_t> file_limit = {};  ///< bytes that a file may grow to
    bool as_ordinary_user = false;          ///< root, too, is then held to the permissions of files
};

struct CommandResult {
    int exit_code = -1;  ///< -1 when a signal ended it
    int signal = 0;      ///< that ended it; 0 when none did
    std::string output;  ///< standard output
    std::string errors;  ///< standard error
    double seconds = 0;
};

/// A program that runs beside the test; killed when the test is done with it.
class Process {
  public:
    explicit Process(Command command)
        : command_(std::move(command)), output_(text_in_memory()), errors_(text_in_memory()) {
        id_ = ::fork();
        if (id_ < 0) throw std::runtime_error("cannot fork");
        if (id_ == 0) become_command();
    }
    ~Process() {
        if (!ended()) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, &status_, 0);
        }
        ::close(output_);
        ::close(errors_);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    pid_t id() const { return id_; }
    void signal(int number) const { ::kill(id_, number); }

    bool ended() {
        if (!ended_) ended_ = ::waitpid(id_, &status_, WNOHANG) == id_;
        return ended_;
    }

    /// Until the program has ended. Throws when that takes longer than its time limit.
    CommandResult wait() {
        while (!ended()) {
            if (seconds() > command_.time_limit) {
                throw std::runtime_error(command_.words.at(0) + " " + command_.words.at(1) +
                                         " did not end in time; it wrote: " + text_of(errors_));
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        CommandResult result;
        if (WIFEXITED(status_)) result.exit_code = WEXITSTATUS(status_);
        if (WIFSIGNALED(status_)) result.signal = WTERMSIG(status_);
        result.output = text_of(output_);
        result.errors = text_of(errors_);
        result.seconds = seconds();
        return result;
    }

  private:
    static int text_in_memory() {
        const int file = ::memfd_create("command", MFD_CLOEXEC);
        if (file < 0) throw std::runtime_error("cannot make a file in memory");
        return file;
    }

    static std::string text_of(int file) {
        std::string text(static_cast<size_t>(::lseek(file, 0, SEEK_END)), '\0');
        const ssize_t got = ::pread(file, text.data(), text.size(), 0);
        text.resize(got > 0 ? static_cast<size_t>(got) : 0);
        return text;
    }

    [[noreturn]] void become_command() const {
        constexpr int cannot_start = 127;
        if (!command_.folder.empty() && ::chdir(command_.folder.c_str()) != 0)
            ::_exit(cannot_start);
        if (command_.file_limit) {
            const rlimit limit{*command_.file_limit, *command_.file_limit};
            ::setrlimit(RLIMIT_FSIZE, &limit);
        }
        if (command_.as_ordinary_user) {
            for (const int power : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH, CAP_FOWNER}) {
                ::prctl(PR_CAPBSET_DROP, power, 0, 0, 0);  // fails where there is none to drop
            }
        }
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(output_, STDOUT_FILENO);
        ::dup2(errors_, STDERR_FILENO);
        std::vector<char*> words;
        for (const std::string& word : command_.words)
            words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        ::execvp(words[0], words.data());
        ::_exit(cannot_start);
    }

    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
    }

    Command command_;
    int output_;
    int errors_;
    pid_t id_ = 0;
    int status_ = 0;
    bool ended_ = false;
    std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

inline CommandResult run(Command command) {
    return Process(std::move(command)).wait();
}
