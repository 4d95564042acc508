// How fast a machine works, in numbers that bench/stage_rates_bench measures: what estimates of
// seconds are made from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kinetome {

/// A sharded stage, or another one that goes through takes.
struct ShardRates {
    double seconds_per_file = 0;       ///< to open, sync and hash it, however small
    double nanoseconds_per_value = 0;  ///< written, by one thread
    double serial_share = 0;           ///< of the time, that more threads do not shorten
};

/// What all takes cost that the takes of a shard are compared with, for every shard anew.
struct SearchRates {
    double nanoseconds_per_row = 0;  ///< a frame at the effector rate, indexed
};

/// Mixtures of one size, by one thread.
struct ClusterRates {
    double clusters = 0;                   ///< κ
    double start_nanoseconds_per_row = 0;  ///< k-means++, and what the first iterations take more
    double iteration_nanoseconds_per_row = 0;  ///< of EM
    double letter_nanoseconds_per_row = 0;     ///< the likeliest cluster
};

struct PoseRates {
    double seconds_per_file = 0;             ///< to open, sync and hash it, however small
    double moments_nanoseconds_per_row = 0;  ///< read, and summed for principal components
    double projection_nanoseconds_per_row = 0;
    double accessibility_nanoseconds_per_pair = 0;  ///< of letters
    double serial_share = 0;
    std::vector<ClusterRates> by_clusters;  ///< ascending; at least one
};

/// How many times as long it takes to find neighbours among so many frames of a class as among
/// 100,000, which rates of the graph of all takes are for.
double crowding(double frames);

struct Rates {
    std::string machine;  ///< processor, for whoever reads the file
    std::string version;  ///< of the program that was measured
    int threads = 1;      ///< of the many that serial shares were measured with
    ShardRates frames;
    ShardRates features;
    PoseRates poses;
    ShardRates pose_hierarchy;    ///< of one file; a value is a pose at one level
    ShardRates signatures;        ///< of one file; a value is a pose
    ShardRates neighbors;         ///< a neighbour is two values
    ShardRates corpus_neighbors;  ///< a neighbour is three values, see crowding()
    SearchRates search;
    ShardRates bundles;       ///< of one file; a value is a frame at the pose rate
    ShardRates bundle_graph;  ///< likewise
    ShardRates segments;      ///< of one file; a value is a frame at the effector rate
    ShardRates primitives;    ///< likewise
};

/// For any κ: between the logarithms of those measured, beyond them in proportion to κ.
ClusterRates rates_of_clusters(const PoseRates& rates, int64_t clusters);

/// Of the machine the program is developed on; good for an order of magnitude elsewhere.
Rates shipped_rates();

std::string write_rates(const Rates& rates);
/// Throws UsageError naming `origin` and line or key for what is missing, unknown or not positive.
Rates parse_rates(std::string_view toml, const std::string& origin);
/// Throws UsageError when there is no such file.
Rates read_rates(const std::filesystem::path& file);

}  // namespace kinetome
