// Lines and words of a small text file, with what a good error message needs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {

constexpr bool is_blank(char character) {
    return character == ' ' || character == '\t' || character == '\r';
}

/// ASCII letters only.
std::string lower_case(std::string_view text);

/// Goes through a text line by line; a line's words end at blanks and at '#', which begins a
/// comment. Lines without words are passed over.
class TextLines {
  public:
    TextLines(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

    /// Moves to the next line that has words; false at the end of the text.
    bool next();
    /// Makes the following next() return the current line again.
    void step_back() { again_ = true; }

    const std::vector<std::string_view>& words() const { return words_; }
    int64_t number() const { return number_; }

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError::at_line(path_, number_, reason);
    }
    [[noreturn]] void fail_expected(const std::string& expected, std::string_view found) const {
        fail("expected " + expected + ", found " + quote_for_message(found));
    }
    /// Checks the number of words after the first.
    void require_arguments(size_t count, const std::string& expected) const;
    /// Word `index` as a finite number.
    double number_at(size_t index) const;

  private:
    std::string_view rest_;
    const std::string& path_;
    std::vector<std::string_view> words_;
    int64_t number_ = 0;
    bool again_ = false;
};

/// Throws InputError for a zero byte: names are stored as texts that end at one.
void require_text(std::string_view text, const std::string& path);

}  // namespace kinetome
