#include "kinetome/report/graph_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "kinetome/report/xml_text.h"
#include "svg_text.h"

namespace kinetome {
namespace {

// Pixels.
constexpr double pixels_a_second = 120, piece_height = 14, least_side = 4;
constexpr double gap = 34, margin = 20, title_height = 44, usual_width = 1200;

struct Point {
    double x = 0, y = 0;
};

struct Box {
    double width = 0, height = 0;
    Point centre = {};

    double reach() const { return std::hypot(width, height) / 2; }
};

/// Nodes that arrows join, in either direction, as they lie on their ring.
struct Ring {
    std::vector<int32_t> nodes;
    double radius = 0, reach = 0;  ///< of the centres, of what is drawn
    Point centre = {};
};

class GraphPicture {
  public:
    GraphPicture(const PrimitiveGraph& nodes, double rate)
        : nodes_(nodes), graph_(nodes.graph), components_(strong_components(graph_)) {
        for (int32_t node = 0; node < graph_.nodes(); ++node) boxes_.push_back(box_of(node, rate));
        make_rings();
        place_rings();
    }

    std::string draw(const std::string& title) const {
        std::string text = fmt::format(
            R"svg(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" )svg"
            R"svg(height="{1}" role="img" aria-labelledby="title" {2} fill="#222">)svg"
            "\n<title id=\"title\">{3}</title>\n"
            R"svg(<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" )svg"
            R"svg(markerHeight="7" markerUnits="userSpaceOnUse" orient="auto">)svg"
            R"svg(<path d="M0 0L8 4L0 8z" fill="#666"/></marker></defs>)svg"
            "\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
            "<text x=\"{4}\" y=\"28\" font-size=\"16\" font-weight=\"bold\">{3}</text>\n",
            svg_number(width_), svg_number(height_), svg_font, xml_text(title), margin);
        for (const Ring& ring : rings_) {
            for (const int32_t node : ring.nodes) text += arrows_from(node, ring);
        }
        for (const NodeLink& link : graph_.links()) text += drawn_link(link);
        for (int32_t node = 0; node < graph_.nodes(); ++node) text += drawn_box(node);
        return text + "</svg>\n";
    }

  private:
    const Box& box(int32_t node) const { return boxes_[static_cast<size_t>(node)]; }

    Box box_of(int32_t node, double rate) const {
        if (!nodes_.style.boxes_by_size) {
            return {svg_text_width(nodes_.name_of(node)) + 12, 1.5 * piece_height};
        }
        return {std::max(least_side, pixels_a_second * graph_.mean_frames(node) / rate),
                piece_height * std::sqrt(double(graph_.members(node).size()))};
    }

    /// The next of a ring follows the last most often; where none of the others does, it is the
    /// first of those that are joined to it.
    void make_rings() {
        std::vector<std::vector<int32_t>> sources(boxes_.size());
        for (int32_t node = 0; node < graph_.nodes(); ++node) {
            for (const int32_t to : graph_.targets(node))
                sources[static_cast<size_t>(to)].push_back(node);
        }
        std::vector<bool> placed(boxes_.size());
        for (int32_t first = 0; first < graph_.nodes(); ++first) {
            if (placed[static_cast<size_t>(first)]) continue;
            Ring ring;
            std::vector<int32_t> waiting{first};
            for (size_t seen = 0;;) {
                int32_t next = ring.nodes.empty() ? -1 : most_frequent(ring.nodes.back(), placed);
                while (next < 0 && seen < waiting.size()) {
                    const int32_t node = waiting[seen++];
                    if (!placed[static_cast<size_t>(node)]) next = node;
                }
                if (next < 0) break;
                placed[static_cast<size_t>(next)] = true;
                ring.nodes.push_back(next);
                const auto targets = graph_.targets(next);
                waiting.insert(waiting.end(), targets.begin(), targets.end());
                const auto& from = sources[static_cast<size_t>(next)];
                waiting.insert(waiting.end(), from.begin(), from.end());
            }
            rings_.push_back(std::move(ring));
        }
    }

    /// Of the nodes that follow and have no place yet; -1: none.
    int32_t most_frequent(int32_t node, const std::vector<bool>& placed) const {
        const auto targets = graph_.targets(node);
        int32_t best = -1;
        size_t most = 0;
        for (size_t edge = 0; edge < targets.size(); ++edge) {
            const size_t times = graph_.successions(node, static_cast<int64_t>(edge)).size();
            if (placed[static_cast<size_t>(targets[edge])] || times <= most) continue;
            best = targets[edge];
            most = times;
        }
        return best;
    }

    /// Boxes side by side along a circle; the rings in lines, the largest first.
    void place_rings() {
        for (Ring& ring : rings_) {
            double around = 0, largest = 0;
            for (const int32_t node : ring.nodes) {
                around += 2 * box(node).reach() + gap;
                largest = std::max(largest, box(node).reach());
            }
            // Chords are shorter than arcs: by π / 2 at most, with two boxes.
            if (ring.nodes.size() > 1) ring.radius = around / (ring.nodes.size() == 2 ? 4 : 5.6);
            ring.reach = ring.radius + largest + gap;
        }
        std::ranges::stable_sort(rings_, std::greater(), &Ring::reach);
        width_ = usual_width;
        for (const Ring& ring : rings_) width_ = std::max(width_, 2 * (ring.reach + margin));
        double x = margin, y = title_height, line = 0;
        for (Ring& ring : rings_) {
            if (x > margin && x + 2 * ring.reach > width_ - margin) {
                x = margin;
                y += line;
                line = 0;
            }
            ring.centre = {x + ring.reach, y + ring.reach};
            x += 2 * ring.reach;
            line = std::max(line, 2 * ring.reach);
            place_boxes(ring);
        }
        height_ = y + line + margin;
    }

    void place_boxes(const Ring& ring) {
        double around = 0;
        for (const int32_t node : ring.nodes) around += 2 * box(node).reach() + gap;
        double at = 0;
        for (const int32_t node : ring.nodes) {
            const double own = 2 * box(node).reach() + gap;
            const double angle = 2 * std::numbers::pi * (at + own / 2) / around;
            at += own;
            boxes_[static_cast<size_t>(node)].centre = {
                ring.centre.x - ring.radius * std::cos(angle),
                ring.centre.y - ring.radius * std::sin(angle)};
        }
    }

    /// Where the way from a box's centre to a point leaves the box.
    static Point border(const Box& box, const Point& to) {
        const double x = to.x - box.centre.x, y = to.y - box.centre.y;
        const double share = std::min(x == 0 ? 1 : box.width / 2 / std::abs(x),
                                      y == 0 ? 1 : box.height / 2 / std::abs(y));
        return {box.centre.x + std::min(1.0, share) * x, box.centre.y + std::min(1.0, share) * y};
    }

    std::string arrows_from(int32_t node, const Ring& ring) const {
        const auto targets = graph_.targets(node);
        std::string text;
        for (size_t edge = 0; edge < targets.size(); ++edge) {
            const size_t times = graph_.successions(node, static_cast<int64_t>(edge)).size();
            text += fmt::format(
                R"svg(<path d="{}" fill="none" stroke="#666" stroke-width="{}" )svg"
                R"svg(marker-end="url(#head)"><title>{} to {}, {}</title></path>)svg"
                "\n",
                arrow(node, targets[edge], ring), svg_number(0.6 + 0.5 * std::log2(double(times))),
                xml_text(nodes_.name_of(node)), xml_text(nodes_.name_of(targets[edge])),
                times == 1 ? "once" : fmt::format("{} times", times));
        }
        return text;
    }

    /// Bent aside, so that the way back is told apart; from a box to itself a loop over its top.
    std::string arrow(int32_t from, int32_t to, const Ring& ring) const {
        const Box &a = box(from), &b = box(to);
        const auto text = [](const Point& point) {
            return svg_number(point.x) + " " + svg_number(point.y);
        };
        if (from == to) {
            const Point top{a.centre.x, a.centre.y - a.height / 2};
            return fmt::format("M{}c-12 -18 20 -18 8 0", text({top.x - 4, top.y}));
        }
        const Point middle{(a.centre.x + b.centre.x) / 2, (a.centre.y + b.centre.y) / 2};
        const double x = b.centre.x - a.centre.x, y = b.centre.y - a.centre.y;
        const Point bend{middle.x + 0.25 * (ring.centre.x - middle.x) - 0.12 * y,
                         middle.y + 0.25 * (ring.centre.y - middle.y) + 0.12 * x};
        return fmt::format("M{}Q{} {}", text(border(a, bend)), text(bend), text(border(b, bend)));
    }

    std::string drawn_link(const NodeLink& link) const {
        const Point &a = box(link.first).centre, &b = box(link.second).centre;
        return fmt::format(
            R"svg(<path d="M{} {}L{} {}" fill="none" stroke="#b86" stroke-width="0.6" )svg"
            R"svg(stroke-dasharray="4 3"><title>{} as {}</title></path>)svg"
            "\n",
            svg_number(a.x), svg_number(a.y), svg_number(b.x), svg_number(b.y),
            xml_text(nodes_.name_of(link.first)), xml_text(nodes_.name_of(link.second)));
    }

    std::string drawn_box(int32_t node) const {
        const Box& box = this->box(node);
        const size_t members = graph_.members(node).size();
        const std::string name = nodes_.name_of(node);
        const bool recurs =
            components_
                .cyclic[static_cast<size_t>(components_.component_of[static_cast<size_t>(node)])];
        std::string text = fmt::format(
            R"svg(<g><title>{}: {} {}{}</title><rect x="{}" y="{}" width="{}" height="{}" rx="2" )svg"
            R"svg(fill="{}" stroke="#222"/>)svg",
            xml_text(name), members, xml_text(nodes_.style.piece), members == 1 ? "" : "s",
            svg_number(box.centre.x - box.width / 2), svg_number(box.centre.y - box.height / 2),
            svg_number(box.width), svg_number(box.height), recurs ? "#77aadd" : "#d4d4d4");
        if (svg_text_width(name) + 6 <= box.width && box.height >= piece_height) {
            text +=
                fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                            svg_number(box.centre.x), svg_number(box.centre.y + 4), xml_text(name));
        }
        return text + "</g>\n";
    }

    const PrimitiveGraph& nodes_;
    const MotionGraph& graph_;
    StrongComponents components_;
    std::vector<Box> boxes_;  ///< by node
    std::vector<Ring> rings_;
    double width_ = 0, height_ = 0;
};

}  // namespace

std::string graph_svg(const std::string& title, const PrimitiveGraph& graph, double rate) {
    return GraphPicture(graph, rate).draw(title);
}

}  // namespace kinetome
