#include "kinetome/stages/rates.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using Catch::Matchers::Contains;

namespace {

PoseRates three_sizes() {
    PoseRates rates;
    for (const double clusters : {10.0, 1000.0, 4000.0}) {
        rates.by_clusters.push_back({.clusters = clusters,
                                     .start_nanoseconds_per_row = 2 * clusters,
                                     .iteration_nanoseconds_per_row = clusters,
                                     .letter_nanoseconds_per_row = clusters / 2});
    }
    return rates;
}

std::string complaint_about(const std::string& toml) {
    try {
        parse_rates(toml, "my rates.toml");
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("between two measured numbers of clusters, costs go by their logarithms") {
    const PoseRates rates = three_sizes();
    CHECK(rates_of_clusters(rates, 1000).iteration_nanoseconds_per_row == Approx(1000));
    CHECK(rates_of_clusters(rates, 100).iteration_nanoseconds_per_row == Approx(100));
    CHECK(rates_of_clusters(rates, 2000).start_nanoseconds_per_row == Approx(4000));
    CHECK(rates_of_clusters(rates, 2000).letter_nanoseconds_per_row == Approx(1000));
}

TEST_CASE("beyond the largest measured number of clusters, costs grow with it") {
    CHECK(rates_of_clusters(three_sizes(), 12'000).iteration_nanoseconds_per_row == Approx(12'000));
    CHECK(rates_of_clusters(three_sizes(), 1).iteration_nanoseconds_per_row == Approx(10));
}

TEST_CASE("more clusters never cost less, by the rates that are shipped") {
    const Rates rates = shipped_rates();
    ClusterRates before = rates_of_clusters(rates.poses, 1);
    for (int64_t clusters = 2; clusters < 40'000; clusters += 1 + clusters / 10) {
        const ClusterRates now = rates_of_clusters(rates.poses, clusters);
        CHECK(now.start_nanoseconds_per_row >= before.start_nanoseconds_per_row);
        CHECK(now.iteration_nanoseconds_per_row >= before.iteration_nanoseconds_per_row);
        CHECK(now.letter_nanoseconds_per_row >= before.letter_nanoseconds_per_row);
        before = now;
    }
}

TEST_CASE("rates that are written are read back, whatever the machine is called") {
    Rates rates = shipped_rates();
    rates.machine = "an \"odd\" \\ machine\n";
    rates.threads = 48;
    const std::string text = write_rates(rates);
    CHECK(write_rates(parse_rates(text, "rates")) == text);
    const TemporaryFolder folder;
    const Rates read = read_rates(folder.write("rates.toml", text));
    CHECK(read.machine == rates.machine);
    CHECK(read.threads == 48);
    CHECK(read.features.serial_share == Approx(rates.features.serial_share));
}

TEST_CASE("a file of rates with anything missing, unknown or impossible is refused") {
    const std::string good = write_rates(shipped_rates());
    REQUIRE(complaint_about(good).empty());
    CHECK_THAT(complaint_about(""), Contains("my rates.toml") && Contains("no section frames") &&
                                        Contains("stage_rates_bench writes such a file"));
    CHECK_THAT(complaint_about("[frames"), Contains("my rates.toml:1:"));
    CHECK_THAT(complaint_about(replaced(good, "seconds_per_file", "seconds_per_fille")),
               Contains("frames.seconds_per_file must be a number"));
    CHECK_THAT(complaint_about(replaced(good, "[poses]\n", "[poses]\nfriction = 1\n")),
               Contains("no rate is called 'friction'"));
    CHECK_THAT(complaint_about("colour = 3\n" + good), Contains("no rate is called 'colour'"));
    CHECK_THAT(
        complaint_about(replaced(good, "nanoseconds_per_value = ", "nanoseconds_per_value = -")),
        Contains("frames.nanoseconds_per_value must be a number that is not negative"));
    CHECK_THAT(complaint_about(replaced(good, "clusters = 30.0", "clusters = 100000.0")),
               Contains("ascending clusters"));
    CHECK_THAT(complaint_about(good.substr(0, good.find("\n[[poses.mixture]]"))),
               Contains("at least one"));
    CHECK_THROWS_AS(read_rates("there/is/no.toml"), UsageError);
}
