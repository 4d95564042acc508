#include "kinetome/stages/rates.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

/// A number of a section of the file.
template <class Section>
struct Field {
    const char* key;
    double Section::*value;
};

constexpr Field<ShardRates> shard_fields[] = {
    {"seconds_per_file", &ShardRates::seconds_per_file},
    {"nanoseconds_per_value", &ShardRates::nanoseconds_per_value},
    {"serial_share", &ShardRates::serial_share},
};

constexpr Field<SearchRates> search_fields[] = {
    {"nanoseconds_per_row", &SearchRates::nanoseconds_per_row},
};

constexpr Field<PoseRates> pose_fields[] = {
    {"seconds_per_file", &PoseRates::seconds_per_file},
    {"moments_nanoseconds_per_row", &PoseRates::moments_nanoseconds_per_row},
    {"projection_nanoseconds_per_row", &PoseRates::projection_nanoseconds_per_row},
    {"accessibility_nanoseconds_per_pair", &PoseRates::accessibility_nanoseconds_per_pair},
    {"serial_share", &PoseRates::serial_share},
};

constexpr Field<ClusterRates> cluster_fields[] = {
    {"clusters", &ClusterRates::clusters},
    {"start_nanoseconds_per_row", &ClusterRates::start_nanoseconds_per_row},
    {"iteration_nanoseconds_per_row", &ClusterRates::iteration_nanoseconds_per_row},
    {"letter_nanoseconds_per_row", &ClusterRates::letter_nanoseconds_per_row},
};

constexpr auto more_pose_keys = {"mixture"};

/// Four digits tell more than a measurement knows, and keep the file readable.
std::string number_text(double value) {
    const std::string text = fmt::format("{:.4g}", value);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string quoted(const std::string& text) {
    std::ostringstream out;
    out << toml::value<std::string>(text);
    return out.str();
}

template <class Section, size_t n>
std::string section_text(const std::string& heading, const Section& section,
                         const Field<Section> (&fields)[n]) {
    std::string text = "\n" + heading + "\n";
    for (const auto& field : fields) {
        text += fmt::format("{} = {}\n", field.key, number_text(section.*field.value));
    }
    return text;
}

/// Reads one file; every complaint names it.
class RatesFile {
  public:
    RatesFile(std::string_view text, std::string origin) : origin_(std::move(origin)) {
        try {
            table_ = toml::parse(text, origin_);
        } catch (const toml::parse_error& error) {
            throw UsageError(
                fmt::format("{}:{}: {}", origin_, error.source().begin.line, error.description()));
        }
    }

    Rates read() const {
        require_known(table_,
                      {"machine", "version", "threads", "frames", "features", "poses", "bundles",
                       "bundle_graph", "pose_hierarchy", "signatures", "neighbors",
                       "corpus_neighbors", "search", "segments", "primitives"});
        Rates rates;
        rates.machine = table_["machine"].value_or(std::string());
        rates.version = table_["version"].value_or(std::string());
        rates.threads = static_cast<int>(table_["threads"].value_or(int64_t{1}));
        rates.frames = section<ShardRates>(table_, "frames", shard_fields);
        rates.features = section<ShardRates>(table_, "features", shard_fields);
        rates.poses = section<PoseRates>(table_, "poses", pose_fields, more_pose_keys);
        rates.poses.by_clusters = mixtures();
        rates.pose_hierarchy = section<ShardRates>(table_, "pose_hierarchy", shard_fields);
        rates.signatures = section<ShardRates>(table_, "signatures", shard_fields);
        rates.neighbors = section<ShardRates>(table_, "neighbors", shard_fields);
        rates.corpus_neighbors = section<ShardRates>(table_, "corpus_neighbors", shard_fields);
        rates.search = section<SearchRates>(table_, "search", search_fields);
        rates.bundles = section<ShardRates>(table_, "bundles", shard_fields);
        rates.bundle_graph = section<ShardRates>(table_, "bundle_graph", shard_fields);
        rates.segments = section<ShardRates>(table_, "segments", shard_fields);
        rates.primitives = section<ShardRates>(table_, "primitives", shard_fields);
        return rates;
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw UsageError(fmt::format("{}: {}; bench/stage_rates_bench writes such a file",
                                     path_for_message(origin_), what));
    }

    void require_known(const toml::table& table, const std::set<std::string>& keys) const {
        for (const auto& [key, node] : table) {
            if (!keys.count(std::string(key.str()))) {
                refuse(fmt::format("line {}: no rate is called {}", node.source().begin.line,
                                   quote_for_message(key.str())));
            }
        }
    }

    template <class Section, size_t n>
    Section values(const toml::table& table, const std::string& name,
                   const Field<Section> (&fields)[n],
                   std::initializer_list<const char*> more = {}) const {
        Section section;
        std::set<std::string> keys(more.begin(), more.end());
        for (const auto& field : fields) {
            keys.insert(field.key);
            const auto value = table[field.key].template value<double>();
            if (!value || !(*value >= 0) || !std::isfinite(*value)) {
                refuse(fmt::format("{}.{} must be a number that is not negative", name, field.key));
            }
            section.*field.value = *value;
        }
        require_known(table, keys);
        return section;
    }

    template <class Section, size_t n>
    Section section(const toml::table& table, const std::string& name,
                    const Field<Section> (&fields)[n],
                    std::initializer_list<const char*> more = {}) const {
        const toml::table* found = table[name].as_table();
        if (!found) refuse("there is no section " + name);
        return values(*found, name, fields, more);
    }

    std::vector<ClusterRates> mixtures() const {
        const toml::array* array = table_["poses"]["mixture"].as_array();
        std::vector<ClusterRates> rates;
        if (array) {
            for (const toml::node& node : *array) {
                if (!node.is_table()) refuse("poses.mixture must be sections");
                rates.push_back(values(*node.as_table(), "poses.mixture", cluster_fields));
            }
        }
        const bool ascends = std::adjacent_find(rates.begin(), rates.end(),
                                                [](const ClusterRates& a, const ClusterRates& b) {
                                                    return a.clusters >= b.clusters;
                                                }) == rates.end();
        if (rates.empty() || !ascends || rates.front().clusters < 1) {
            refuse("poses.mixture must be sections of ascending clusters, at least one");
        }
        return rates;
    }

    std::string origin_;
    toml::table table_;
};

double between_logarithms(double a, double b, double share) {
    if (a <= 0 || b <= 0) return a + share * (b - a);
    return std::exp(std::log(a) + share * (std::log(b) - std::log(a)));
}

}  // namespace

ClusterRates rates_of_clusters(const PoseRates& rates, int64_t clusters) {
    const auto wanted = static_cast<double>(clusters);
    const auto above = std::find_if(rates.by_clusters.begin(), rates.by_clusters.end(),
                                    [&](const ClusterRates& r) { return r.clusters >= wanted; });
    ClusterRates result;
    if (above == rates.by_clusters.end()) {
        const ClusterRates& last = rates.by_clusters.back();
        for (const auto& field : cluster_fields) {
            result.*field.value = last.*field.value * wanted / last.clusters;
        }
    } else if (above == rates.by_clusters.begin()) {
        result = *above;  // what a row costs by itself counts most there
    } else {
        const ClusterRates& below = *std::prev(above);
        const double share = (std::log(wanted) - std::log(below.clusters)) /
                             (std::log(above->clusters) - std::log(below.clusters));
        for (const auto& field : cluster_fields) {
            result.*field.value =
                between_logarithms(below.*field.value, (*above).*field.value, share);
        }
    }
    result.clusters = wanted;
    return result;
}

double crowding(double frames) {
    constexpr double rated = 100'000;
    constexpr double growth = 0.4;  // in the CMU corpus, between 20,000 and 330,000 frames
    return std::pow(frames / rated, growth);
}

std::string write_rates(const Rates& rates) {
    std::string text =
        "# Measured by bench/stage_rates_bench; `kinetome plan --rates` reads it.\n"
        "# Times are those of one thread.\n";
    text += fmt::format("machine = {}\nversion = {}\nthreads = {}\n", quoted(rates.machine),
                        quoted(rates.version), rates.threads);
    text += section_text("[frames]", rates.frames, shard_fields);
    text += section_text("[features]", rates.features, shard_fields);
    text += section_text("[pose_hierarchy]", rates.pose_hierarchy, shard_fields);
    text += section_text("[signatures]", rates.signatures, shard_fields);
    text += section_text("[neighbors]", rates.neighbors, shard_fields);
    text += section_text("[corpus_neighbors]", rates.corpus_neighbors, shard_fields);
    text += section_text("[search]", rates.search, search_fields);
    text += section_text("[bundles]", rates.bundles, shard_fields);
    text += section_text("[bundle_graph]", rates.bundle_graph, shard_fields);
    text += section_text("[segments]", rates.segments, shard_fields);
    text += section_text("[primitives]", rates.primitives, shard_fields);
    text += section_text("[poses]", rates.poses, pose_fields);
    for (const ClusterRates& one : rates.poses.by_clusters) {
        text += section_text("[[poses.mixture]]", one, cluster_fields);
    }
    return text;
}

Rates parse_rates(std::string_view toml, const std::string& origin) {
    return RatesFile(toml, origin).read();
}

Rates read_rates(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file)) {
        throw UsageError(path_for_message(file.string()) + ": no such file of rates");
    }
    return parse_rates(read_file(file), file.string());
}

}  // namespace kinetome
