#include "kinetome/report/timeline_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kinetome/report/xml_text.h"
#include "svg_text.h"

namespace kinetome {
namespace {

// Pixels.
constexpr double width = 1000, least_left = 110, right = 26;
constexpr double rows_top = 52, row_height = 38, row_gap = 14;
constexpr double axis_height = 40, legend_line = 24, margin = 14;

/// Paul Tol's "light" colours: told apart without colour vision, and black text stands on them.
constexpr std::array colours = {"#77aadd", "#ee8866", "#eedd88", "#ffaabb",
                                "#99ddff", "#44bb99", "#bbcc33", "#aaaa00"};
constexpr std::string_view grey = "#d4d4d4";

constexpr std::string_view head = R"svg(<defs>
<pattern id="zone" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
<rect width="7" height="7" fill="#fff" fill-opacity=".45"/>
<rect width="2.2" height="7" fill="#222" fill-opacity=".7"/>
</pattern>
<pattern id="dots" width="8" height="8" patternUnits="userSpaceOnUse">
<circle cx="2" cy="2" r="1.1" fill="#222" fill-opacity=".5"/>
<circle cx="6" cy="6" r="1.1" fill="#222" fill-opacity=".5"/>
</pattern>
</defs>
)svg";

/// What an area of a colour number is filled with; past the last colour they come again, dotted.
std::string filled_rect(double x, double y, double w, double h, std::optional<int32_t> colour) {
    const auto rect = [&](std::string_view fill) {
        return fmt::format(
            R"svg(<rect x="{}" y="{}" width="{}" height="{}" rx="2" fill="{}" stroke="#fff"/>)svg"
            "\n",
            svg_number(x), svg_number(y), svg_number(w), svg_number(h), fill);
    };
    if (!colour) return rect(grey);
    const auto shade = static_cast<size_t>(*colour);
    const bool again = shade >= colours.size();
    return rect(colours[shade % colours.size()]) + (again ? rect("url(#dots)") : "");
}

class TimelinePicture {
  public:
    explicit TimelinePicture(const Timeline& timeline)
        : timeline_(timeline), left_(room_for_names(timeline)) {}

    std::string draw() {
        draw_title();
        double y = rows_top;
        for (const TimelineRow& row : timeline_.rows) {
            draw_row(row, y);
            y += row_height + row_gap;
        }
        draw_axis(y);
        const double height = draw_legend(y + axis_height) + margin;
        return opening(height) + body_ + "</svg>\n";
    }

  private:
    static double room_for_names(const Timeline& timeline) {
        double room = least_left;
        for (const TimelineRow& row : timeline.rows) {
            room = std::max(room, svg_text_width(row.name) + 2 * margin);
        }
        return std::min(room, width / 2);
    }

    double x_of(int64_t frame) const {
        const auto frames = static_cast<double>(std::max<int64_t>(timeline_.frames, 1));
        return left_ + (width - left_ - right) * static_cast<double>(frame) / frames;
    }
    double seconds(int64_t frame) const { return static_cast<double>(frame) / timeline_.rate; }

    std::string opening(double height) const {
        std::string text =
            fmt::format(R"svg(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" )svg"
                        R"svg(width="{0}" height="{1}" role="img" aria-labelledby="title" )svg"
                        R"svg({2} fill="#222">)svg"
                        "\n<title id=\"title\">{3}</title>\n",
                        svg_number(width), svg_number(height), svg_font, xml_text(timeline_.title));
        text += head;
        return text + fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n",
                                  svg_number(width), svg_number(height));
    }

    void write(double x, double y, std::string_view anchor, std::string_view text) {
        body_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n",
                             svg_number(x), svg_number(y), anchor, xml_text(text));
    }

    void draw_title() {
        body_ +=
            fmt::format("<text x=\"{}\" y=\"30\" font-size=\"16\" font-weight=\"bold\">{}</text>\n",
                        svg_number(left_), xml_text(timeline_.title));
    }

    void draw_row(const TimelineRow& row, double y) {
        write(left_ - 12, y + row_height / 2 + 4, "end", row.name);
        for (const TimelineBar& bar : row.bars) draw_bar(bar, y);
        for (const RowRange& zone : row.uncertain) {
            draw_zone(x_of(zone.first), y, x_of(zone.end) - x_of(zone.first), row_height);
        }
        for (const int64_t tick : row.ticks) draw_tick(x_of(tick), y + row_height - 11);
        for (const TimelineBar& bar : row.bars) write_name(bar, row.uncertain, y);
    }

    void draw_bar(const TimelineBar& bar, double y) {
        const double x = x_of(bar.frames.first), w = x_of(bar.frames.end) - x;
        body_ += fmt::format("<g><title>{}, {:.2f} s to {:.2f} s</title>\n", xml_text(bar.name),
                             seconds(bar.frames.first), seconds(bar.frames.end));
        body_ += filled_rect(x, y, w, row_height, bar.colour) + "</g>\n";
    }

    void draw_zone(double x, double y, double w, double h) {
        body_ +=
            fmt::format(R"svg(<rect x="{}" y="{}" width="{}" height="{}" fill="url(#zone)"/>)svg"
                        "\n",
                        svg_number(x), svg_number(y), svg_number(w), svg_number(h));
    }

    void draw_tick(double x, double y) {
        body_ += fmt::format(R"svg(<path d="M{} {}v10.5" stroke="#222" stroke-opacity=".6"/>)svg"
                             "\n",
                             svg_number(x), svg_number(y));
    }

    /// Where the bar is not hatched, if it has room there.
    void write_name(const TimelineBar& bar, const std::vector<RowRange>& hatched, double y) {
        RowRange clear = bar.frames;
        for (const RowRange& zone : hatched) {
            if (zone.first <= clear.first) clear.first = std::max(clear.first, zone.end);
            if (zone.end >= clear.end) clear.end = std::min(clear.end, zone.first);
        }
        const double x = x_of(clear.first), w = x_of(clear.end) - x;
        if (svg_text_width(bar.name) + 8 > w) return;
        write(x + w / 2, y + row_height / 2 + 2, "middle", bar.name);
    }

    /// The least of 1, 2 or 5 times a power of ten seconds that leaves the marks room.
    double mark_spacing() const {
        constexpr double least_pixels = 55;
        const double pixels = (width - left_ - right) / std::max(seconds(timeline_.frames), 1e-9);
        double spacing = 0.01;
        for (int i = 0; spacing * pixels < least_pixels; ++i) {
            spacing *= i % 3 == 1 ? 2.5 : 2;
        }
        return spacing;
    }

    void draw_axis(double y) {
        const double spacing = mark_spacing();
        body_ += fmt::format(R"svg(<path d="M{} {}H{}" stroke="#222" fill="none"/>)svg"
                             "\n",
                             svg_number(left_), svg_number(y), svg_number(width - right));
        const double last = seconds(timeline_.frames);
        for (int64_t i = 0; double(i) * spacing <= last + 1e-9; ++i) {
            const double time = double(i) * spacing;
            const double x = left_ + (width - left_ - right) * time / std::max(last, 1e-9);
            body_ += fmt::format(R"svg(<path d="M{} {}v5" stroke="#222" fill="none"/>)svg"
                                 "\n",
                                 svg_number(x), svg_number(y));
            write(x, y + 18, "middle", svg_number(time) + (i == 0 ? " s" : ""));
        }
    }

    /// Of colours that have names, and of the marks there are. Returns where it ends.
    double draw_legend(double y) {
        double x = left_;
        const auto entry = [&](const std::string& name, const auto& draw_swatch) {
            const double w = 22 + svg_text_width(name) + 18;
            if (x > left_ && x + w > width - right) {
                x = left_;
                y += legend_line;
            }
            draw_swatch();
            write(x + 22, y + 12, "start", name);
            x += w;
        };
        const auto bar_entry = [&](const std::string& name, std::optional<int32_t> colour) {
            entry(name, [&] { body_ += filled_rect(x, y, 16, 16, colour); });
        };
        for (size_t colour = 0; colour < timeline_.colour_names.size(); ++colour) {
            bar_entry(timeline_.colour_names[colour], static_cast<int32_t>(colour));
        }
        if (has_transitions()) bar_entry("transition", std::nullopt);
        if (has(&TimelineRow::uncertain)) {
            entry("boundary uncertain", [&] { draw_zone(x, y, 16, 16); });
        }
        if (has(&TimelineRow::ticks)) {
            entry("a primitive begins", [&] { draw_tick(x + 8, y + 3); });
        }
        return y + legend_line;
    }

    bool has_transitions() const {
        return std::any_of(timeline_.rows.begin(), timeline_.rows.end(), [](const auto& row) {
            return std::any_of(row.bars.begin(), row.bars.end(),
                               [](const TimelineBar& bar) { return !bar.colour; });
        });
    }

    template <class Part>
    bool has(Part TimelineRow::*part) const {
        return std::any_of(timeline_.rows.begin(), timeline_.rows.end(),
                           [&](const TimelineRow& row) { return !(row.*part).empty(); });
    }

    const Timeline& timeline_;
    double left_;
    std::string body_;
};

}  // namespace

std::string timeline_svg(const Timeline& timeline) {
    return TimelinePicture(timeline).draw();
}

}  // namespace kinetome
