// What the benchmarks' command lines have in common. CLI11 is compiled once for all of them, which
// takes longer than most of their own code.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kinetome::bench {

class Program {
  public:
    explicit Program(const std::string& question);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    enum class Need { required, optional };

    void argument(const std::string& name, std::filesystem::path& value, const std::string& what,
                  Need need = Need::required);
    /// Of the types that program.cpp lists; what the value holds is the default. Entries of a list
    /// are separated by commas or spaces.
    template <class Value>
    void option(const std::string& name, Value& value, const std::string& what = {});
    /// The same for a number that must be positive.
    template <class Number>
    void count(const std::string& name, Number& value, const std::string& what = {});
    void choice(const std::string& name, std::string& value, std::vector<std::string> choices,
                const std::string& what = {});
    void flag(const std::string& name, bool& value, const std::string& what = {});

    /// Reads the command line and works: what main returns, 0 if the work returns true.
    int run(int argc, char** argv, const std::function<bool()>& work);

  private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace kinetome::bench
