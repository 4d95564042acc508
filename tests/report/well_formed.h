// Whether a text is well-formed XML as far as our pictures use it: elements that nest, attributes
// in double quotes, references, no text outside the one outermost element.
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

class XmlReader {
  public:
    explicit XmlReader(std::string_view text) : text_(text) {}

    bool is_well_formed() {
        if (!read_element()) return false;
        skip_spaces();
        return at_ == text_.size();
    }

  private:
    bool skip(std::string_view token) {
        if (!text_.substr(at_).starts_with(token)) return false;
        at_ += token.size();
        return true;
    }
    void skip_spaces() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    std::string_view read_name() {
        const size_t first = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) ||
                                      text_[at_] == '-' || text_[at_] == ':')) {
            ++at_;
        }
        return text_.substr(first, at_ - first);
    }
    /// Characters up to `end`, which is not one of them.
    bool read_text(char end) {
        for (; at_ < text_.size() && text_[at_] != end; ++at_) {
            const auto byte = static_cast<unsigned char>(text_[at_]);
            if (byte == '<' || byte == '>' || (byte < 0x20 && byte != '\n')) return false;
            if (byte == '&' && !read_reference()) return false;
        }
        return at_ < text_.size();
    }
    bool read_reference() {
        for (const std::string_view known : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
            if (!text_.substr(at_).starts_with(known)) continue;
            at_ += known.size() - 1;
            return true;
        }
        return false;
    }
    bool read_attributes() {
        std::vector<std::string_view> names;
        for (;;) {
            skip_spaces();
            if (text_.substr(at_).starts_with(">") || text_.substr(at_).starts_with("/>")) {
                return true;
            }
            const std::string_view name = read_name();
            for (const std::string_view other : names) {
                if (name == other) return false;
            }
            names.push_back(name);
            if (name.empty() || !skip("=\"") || !read_text('"') || !skip("\"")) return false;
        }
    }
    bool read_element() {
        if (!skip("<")) return false;
        const std::string name(read_name());
        if (name.empty() || !read_attributes()) return false;
        if (skip("/>")) return true;
        if (!skip(">")) return false;
        while (read_text('<') && !text_.substr(at_).starts_with("</")) {
            if (!read_element()) return false;
        }
        return skip("</" + name + ">");
    }

    std::string_view text_;
    size_t at_ = 0;
};

inline bool well_formed(std::string_view text) {
    return XmlReader(text).is_well_formed();
}
