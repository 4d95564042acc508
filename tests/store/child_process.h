// Work done by a forked process, with what it has to say.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

enum class ChildEnd {
    at_once,  ///< _exit
    exit,     ///< exit(): what libraries do at the end is done
};

struct ChildResult {
    int status = -1;
    std::string output;
    bool finished_well() const { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }
};

namespace child_process {

template <class Work>
[[noreturn]] void work_as_child(int answer, const Work& work, ChildEnd end) {
    std::string text;
    int code = 0;
    try {
        text = work();
    } catch (const std::exception& error) {
        text = std::string("unexpected: ") + error.what();
        code = 1;
    }
    if (::write(answer, text.data(), text.size()) < 0) code = 1;
    if (end == ChildEnd::exit) std::exit(code);
    ::_exit(code);
}

}  // namespace child_process

/// Runs `work`, which returns a text, in a child process and waits for it, a minute at most.
template <class Work>
ChildResult run_in_child(const Work& work, ChildEnd end = ChildEnd::at_once) {
    // Else both processes would print what waits to be printed.
    std::cout.flush();
    std::fflush(nullptr);
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::runtime_error("pipe");
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("fork");
    if (child == 0) {
        ::alarm(60);
        ::close(ends[0]);
        child_process::work_as_child(ends[1], work, end);
    }
    ::close(ends[1]);
    ChildResult result;
    std::array<char, 4096> block;
    for (ssize_t got = 0; (got = ::read(ends[0], block.data(), block.size())) > 0;) {
        result.output.append(block.data(), static_cast<size_t>(got));
    }
    ::close(ends[0]);
    ::waitpid(child, &result.status, 0);
    return result;
}
