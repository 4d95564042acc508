#include "checks.h"

#include <string>

namespace kinetome::cli {
namespace {

template <class Accepts>
CLI::Validator number_check(const std::string& expected, const Accepts& accepts) {
    return CLI::Validator(
        [=](const std::string& text) {
            double number = 0;
            const bool known = CLI::detail::lexical_cast(text, number);
            return known && accepts(number) ? std::string()
                                            : "expected " + expected + ", found " + text;
        },
        "");
}

}  // namespace

const CLI::Validator& above_zero() {
    static const CLI::Validator check =
        number_check("a number above 0", [](double number) { return number > 0; });
    return check;
}

const CLI::Validator& zero_or_above() {
    static const CLI::Validator check =
        number_check("0 or a number above", [](double number) { return number >= 0; });
    return check;
}

}  // namespace kinetome::cli
