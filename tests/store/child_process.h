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

/// A forked process that does `work` and ends; killed, at the latest, with this object.
class ChildProcess {
  public:
    template <class Work>
    explicit ChildProcess(const Work& work) : process_(::fork()) {
        // Never kill process -1: that is every process.
        if (process_ < 0) throw std::runtime_error("cannot fork");
        if (process_ > 0) return;
        ::alarm(60);
        try {
            work();
        } catch (...) {
            ::_exit(1);
        }
        ::_exit(0);
    }
    ~ChildProcess() {
        kill();
        wait();
    }
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    pid_t id() const { return process_; }
    void kill() {
        if (!waited_) ::kill(process_, SIGKILL);
    }
    /// The status it ended with.
    int wait() {
        if (!waited_) ::waitpid(process_, &status_, 0);
        waited_ = true;
        return status_;
    }

  private:
    pid_t process_;
    int status_ = -1;
    bool waited_ = false;
};

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
void answer(int pipe, const Work& work, ChildEnd end) {
    std::string text;
    int code = 0;
    try {
        text = work();
    } catch (const std::exception& error) {
        text = std::string("unexpected: ") + error.what();
        code = 1;
    }
    if (::write(pipe, text.data(), text.size()) < 0) code = 1;
    if (end == ChildEnd::exit) std::exit(code);
    ::_exit(code);
}

}  // namespace child_process

/// A child process at `work`, which returns a text: a minute at most. Children that work side by
/// side are begun one after the other by one thread: who forks while another thread holds the lock
/// of an allocator (a sanitizer's is not mended after a fork) has a child that waits for it for
/// ever.
class AnsweringChild {
  public:
    template <class Work>
    explicit AnsweringChild(const Work& work, ChildEnd end = ChildEnd::at_once)
        : ends_(make_pipe()), process_([&] {
              ::close(ends_[0]);
              child_process::answer(ends_[1], work, end);
          }) {
        ::close(ends_[1]);
    }
    ~AnsweringChild() { ::close(ends_[0]); }
    AnsweringChild(const AnsweringChild&) = delete;
    AnsweringChild& operator=(const AnsweringChild&) = delete;

    ChildResult wait() {
        ChildResult result;
        std::array<char, 4096> block;
        for (ssize_t got = 0; (got = ::read(ends_[0], block.data(), block.size())) > 0;) {
            result.output.append(block.data(), static_cast<size_t>(got));
        }
        result.status = process_.wait();
        return result;
    }

  private:
    static std::array<int, 2> make_pipe() {
        // Else both processes would print what waits to be printed.
        std::cout.flush();
        std::fflush(nullptr);
        std::array<int, 2> ends{};
        if (::pipe(ends.data()) != 0) throw std::runtime_error("pipe");
        return ends;
    }

    std::array<int, 2> ends_;
    ChildProcess process_;
};

/// Runs `work` in a child process and waits for it.
template <class Work>
ChildResult run_in_child(const Work& work, ChildEnd end = ChildEnd::at_once) {
    return AnsweringChild(work, end).wait();
}
