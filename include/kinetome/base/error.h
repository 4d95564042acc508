// Errors and the exit codes they end in (design: "Command line", exit codes).
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace kinetome {

/// What a command answers to the shell.
enum class ExitCode : int {
    success = 0,
    some_quarantined = 3,  ///< published, but some clips were left out
    usage = 64,            ///< the command line or the configuration is wrong
    nothing_usable = 65,   ///< no clip of the corpus could be indexed
    internal = 70,         ///< a bug
    cannot_create = 73,    ///< no permission, disk full, store held by another run
    io = 74,               ///< reading or writing failed, or the store is damaged
    interrupted = 75,      ///< stopped by a signal; the same command resumes
};

/// An error that a user can act on; what() says what happened and what to do next.
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode exit_code() const { return code_; }

  private:
    ExitCode code_;
};

/// The command line or the configuration asks for something impossible.
struct UsageError : Error {
    explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// A source file that cannot be used. It is quarantined; the rest of the corpus goes on.
/// what() is "path:line: reason" (or "path: byte N: reason", or "path: reason").
struct InputError : Error {
    explicit InputError(const std::string& message) : Error(ExitCode::nothing_usable, message) {}
    static InputError at_line(const std::string& path, int64_t line, const std::string& reason) {
        return InputError(path + ":" + std::to_string(line) + ": " + reason);
    }
    static InputError at_byte(const std::string& path, int64_t byte, const std::string& reason) {
        return InputError(path + ": byte " + std::to_string(byte) + ": " + reason);
    }
    static InputError in_file(const std::string& path, const std::string& reason) {
        return InputError(path + ": " + reason);
    }
};

/// A file that could not be made: permission, disk full, or a store held by another run.
struct CreateError : Error {
    explicit CreateError(const std::string& message) : Error(ExitCode::cannot_create, message) {}
};

/// Reading or writing failed, or what was read is damaged.
struct StoreError : Error {
    explicit StoreError(const std::string& message) : Error(ExitCode::io, message) {}
};

/// What was read is not what was written; making it again may help, where reading again will not.
struct DamagedError : StoreError {
    using StoreError::StoreError;
};

/// A signal asked the run to stop; finished work is kept.
struct Interrupted : Error {
    Interrupted() : Error(ExitCode::interrupted, "stopped by a signal") {}
};

}  // namespace kinetome
