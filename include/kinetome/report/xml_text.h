// Text made fit to stand in XML: in SVG pictures, as text or as an attribute in double quotes.
#pragma once

#include <string>
#include <string_view>

namespace kinetome {

/// & < > " ' are replaced by references. What XML 1.0 cannot hold (control characters, bytes that
/// are no UTF-8) becomes U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace kinetome
