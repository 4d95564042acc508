#include "text_lines.h"

#include <algorithm>
#include <cmath>

#include "kinetome/base/error.h"
#include "kinetome/formats/number_text.h"

namespace kinetome {
namespace {

void split_words(std::string_view line, std::vector<std::string_view>& words) {
    words.clear();
    line = line.substr(0, line.find('#'));
    while (!line.empty()) {
        const auto begin = std::ranges::find_if_not(line, is_blank);
        const auto end = std::find_if(begin, line.end(), is_blank);
        if (begin != end) words.emplace_back(begin, end);
        line = {end, line.end()};
    }
}

}  // namespace

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& letter : lower) {
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    }
    return lower;
}

bool TextLines::next() {
    if (again_) {
        again_ = false;
        return true;
    }
    while (!rest_.empty()) {
        const size_t end = std::min(rest_.find('\n'), rest_.size());
        split_words(rest_.substr(0, end), words_);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++number_;
        if (!words_.empty()) return true;
    }
    words_.clear();
    return false;
}

void TextLines::require_arguments(size_t count, const std::string& expected) const {
    if (words_.size() == count + 1) return;
    fail("expected " + expected + ", found " + std::to_string(words_.size() - 1) + " words after " +
         quote_for_message(words_.front()));
}

double TextLines::number_at(size_t index) const {
    const std::string_view word = words_.at(index);
    const char* const end = word.data() + word.size();
    double value = 0;
    if (parse_number(word.data(), end, value) != end || !std::isfinite(value)) {
        fail_expected("a finite number", word);
    }
    return value;
}

void require_text(std::string_view text, const std::string& path) {
    const size_t zero = text.find('\0');
    if (zero == std::string_view::npos) return;
    throw InputError::at_byte(path, static_cast<int64_t>(zero), "expected text, found a zero byte");
}

}  // namespace kinetome
