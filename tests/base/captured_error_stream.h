// Standard error, caught while an object of these lives.
#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <cstdio>
#include <stdexcept>
#include <string>

#include "kinetome/base/file.h"
#include "support/temporary_folder.h"

/// Sends standard error to `descriptor` and back.
class RedirectedErrorStream {
  public:
    explicit RedirectedErrorStream(int descriptor) : original_(::dup(STDERR_FILENO)) {
        std::fflush(stderr);
        ::dup2(descriptor, STDERR_FILENO);
    }
    ~RedirectedErrorStream() {
        std::fflush(stderr);
        ::dup2(original_, STDERR_FILENO);
        ::close(original_);
    }
    RedirectedErrorStream(const RedirectedErrorStream&) = delete;
    RedirectedErrorStream& operator=(const RedirectedErrorStream&) = delete;

  private:
    int original_;
};

/// What `body` writes to standard error when that is a file.
template <class Body>
std::string captured_error_stream(Body&& body) {
    const TemporaryFolder folder;
    const auto file = folder.write("stderr", "");
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND);
    {
        const RedirectedErrorStream redirected(descriptor);
        ::close(descriptor);
        body();
    }
    return kinetome::read_file(file);
}

/// Whether this system has pseudo-terminals; a bare container need not. Warns when it has none.
inline bool has_terminals() {
    const int screen = ::posix_openpt(O_RDWR | O_NOCTTY);
    const bool usable = screen >= 0 && ::grantpt(screen) == 0 && ::unlockpt(screen) == 0;
    if (screen >= 0) ::close(screen);
    if (!usable) WARN("SKIPPED: no pseudo-terminal to test on");
    return usable;
}

/// What `body` writes to standard error when that is a terminal (at most a few kilobytes).
template <class Body>
std::string captured_terminal(Body&& body) {
    const int screen = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (screen < 0 || ::grantpt(screen) != 0 || ::unlockpt(screen) != 0) {
        throw std::runtime_error("no pseudo-terminal to test on");
    }
    const int terminal = ::open(::ptsname(screen), O_RDWR | O_NOCTTY);
    ::setenv("TERM", "xterm", 1);
    {
        const RedirectedErrorStream redirected(terminal);
        body();
    }
    ::fcntl(screen, F_SETFL, O_NONBLOCK);
    std::string shown;
    char buffer[4096];
    for (ssize_t got; (got = ::read(screen, buffer, sizeof buffer)) > 0;) {
        shown.append(buffer, static_cast<size_t>(got));
    }
    ::close(terminal);
    ::close(screen);
    return shown;
}
