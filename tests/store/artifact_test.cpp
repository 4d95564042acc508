#include "kinetome/store/artifact.h"

#include <dlfcn.h>
#include <malloc.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <thread>

#include "artifact_example.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using namespace artifact_example;
using Catch::Contains;

namespace {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

void check_reads_back(const std::filesystem::path& path, const ArtifactRecord& record,
                      const std::vector<Data>& all) {
    const ArtifactReader reader(path, record.hash);
    REQUIRE(reader.datasets().size() == all.size());
    for (const Data& data : all) {
        INFO(data.spec.path);
        CHECK(reader.spec(data.spec.path) == data.spec);
        CHECK(reader.rows(data.spec.path) == static_cast<int64_t>(data.rows()));
        CHECK(bytes_of(read(reader, data)) == bytes_of(data));
    }
}

std::vector<Compression> compressions_here() {
    std::vector<Compression> found{Compression::none, Compression::gzip};
    try {
        found.push_back(parse_compression("blosc"));
        // HDF5 unloads the plugin at its end, and then what blosc holds would count as leaked.
        ::dlopen("libblosc.so.1", RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
    } catch (const UsageError&) {
        WARN("SKIPPED: blosc, whose HDF5 plugin is not installed");
    }
    return found;
}

}  // namespace

TEST_CASE("every type comes back as it was written, with or without compression") {
    const TemporaryFolder folder;
    // Fewer rows than a chunk, and several chunks with a rest.
    for (const size_t rows : {size_t{0}, size_t{1}, size_t{7}, size_t{3000}, size_t{300'001}}) {
        const std::vector<Data> all = every_type(rows > 3000 ? 3000 : rows);
        std::vector<Data> long_ones{data<float>("/long", {}, rows),
                                    data<uint8_t>("/bytes", {}, rows),
                                    data<std::string>("/texts", {}, rows)};
        for (const Compression compression : compressions_here()) {
            check_reads_back(folder / "a.h5", write(folder / "a.h5", all, 0, compression), all);
            check_reads_back(folder / "b.h5", write(folder / "b.h5", long_ones, 0, compression),
                             long_ones);
        }
    }
}

TEST_CASE("compression makes files smaller and changes no digest") {
    const TemporaryFolder folder;
    const std::vector<Data> all{data<int64_t>("/steps", {}, 200'000)};
    const ArtifactRecord plain = write(folder / "plain.h5", all);
    for (const Compression compression : compressions_here()) {
        if (compression == Compression::none) continue;
        const ArtifactRecord record = write(folder / "small.h5", all, 0, compression);
        CHECK(record.bytes < plain.bytes * 3 / 4);
        CHECK(record.datasets == plain.datasets);
    }
}

TEST_CASE("the same rows give the same bytes, however they are split among calls") {
    const TemporaryFolder folder;
    const std::vector<Data> all = every_type(20'000);
    const ArtifactRecord whole = write(folder / "whole.h5", all);
    for (const size_t piece : {1, 17, 1024, 19'999}) {
        // Memory that HDF5 forgets to set would differ.
        ::mallopt(M_PERTURB, static_cast<int>(piece % 200 + 1));
        const ArtifactRecord record = write(folder / "pieces.h5", all, piece);
        ::mallopt(M_PERTURB, 0);
        CHECK(record.hash == whole.hash);
        CHECK(record.datasets == whole.datasets);
    }
}

TEST_CASE(
    "a file that is put together on another disk has the same bytes, and leaves nothing there") {
    const TemporaryFolder folder, scratch;
    const ArtifactRecord near = write(folder / "near.h5", every_type(5000));
    const ArtifactRecord far =
        write(folder / "far.h5", every_type(5000), 0, {Compression::none, scratch.path()});
    CHECK(far.hash == near.hash);
    CHECK(far.bytes == near.bytes);
    CHECK(read_file(folder / "far.h5") == read_file(folder / "near.h5"));
    CHECK(std::filesystem::is_empty(scratch.path()));
    {
        ArtifactWriter unfinished(folder / "far.h5", {.stage = "example"},
                                  {Compression::none, scratch.path()});
        CHECK_FALSE(std::filesystem::is_empty(scratch.path()));
    }
    CHECK(std::filesystem::is_empty(scratch.path()));
    CHECK(digest_file(folder / "far.h5") == near.hash);
}

TEST_CASE("a file tells nothing of the time when it was made") {
    const TemporaryFolder folder;
    const std::vector<Data> all = every_type(10);
    const ArtifactRecord first = write(folder / "a.h5", all);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    CHECK(write(folder / "b.h5", all).hash == first.hash);
}

TEST_CASE("matrices are written and read as rows, strided views too") {
    const TemporaryFolder folder;
    MatrixF positions(500, 93);
    MatrixD mean(4, 5);
    for (Eigen::Index i = 0; i < positions.size(); ++i) positions.data()[i] = static_cast<float>(i);
    for (Eigen::Index i = 0; i < mean.size(); ++i)
        mean.data()[i] = 1.0 / static_cast<double>(i + 1);
    ArtifactWriter writer(folder / "a.h5", {.stage = "example"});
    writer.create({.path = "/positions", .row_shape = {31, 3}});
    writer.append("/positions", positions.topRows(123));
    writer.append("/positions", positions.bottomRows(377));
    writer.create({.path = "/columns", .row_shape = {2}});
    writer.append("/columns", positions.middleCols(10, 2));
    writer.create({.path = "/mean", .type = ElementType::float64, .row_shape = {5}});
    writer.append("/mean", mean);
    const ArtifactReader reader(folder / "a.h5", writer.close().hash);
    CHECK(reader.read_matrix("/positions") == positions);
    CHECK(reader.read_matrix("/positions", 100, 50) == positions.middleRows(100, 50));
    CHECK(reader.read_matrix("/positions", 500, 0).rows() == 0);
    CHECK(reader.read_matrix("/columns") == positions.middleCols(10, 2));
    CHECK(reader.read_matrix_double("/mean") == mean);
}

TEST_CASE("texts keep every byte but zero, which is refused") {
    const TemporaryFolder folder;
    const std::vector<std::string> texts{"",
                                         "\xFF\xC3",
                                         "\xC3\x9C"
                                         "bung",
                                         " blank \n",
                                         "",
                                         std::string(1000, 'x')};
    {
        ArtifactWriter writer(folder / "a.h5", {});
        writer.write_texts({.path = "/texts", .type = ElementType::text}, texts);
        const ArtifactReader reader(folder / "a.h5", writer.close().hash);
        CHECK(reader.read_texts("/texts") == texts);
    }
    ArtifactWriter writer(folder / "b.h5", {});
    writer.create({.path = "/texts", .type = ElementType::text});
    const std::vector<std::string> zero{std::string("a\0", 2)};
    CHECK_THROWS_AS(writer.append_texts("/texts", zero), std::logic_error);
}

TEST_CASE("the header comes back") {
    const TemporaryFolder folder;
    const ArtifactHeader header{.stage = "pose clusters", .key = digest_of("the key")};
    ArtifactWriter writer(folder / "a.h5", header);
    const ArtifactReader reader(folder / "a.h5", writer.close().hash);
    CHECK(reader.header() == header);
    CHECK(reader.datasets().empty());
}

TEST_CASE(
    "nothing is seen under the final name before close, and nothing is left of a writer that "
    "was dropped") {
    const TemporaryFolder folder;
    const std::vector<Data> all = every_type(50'000);
    {
        ArtifactWriter writer(folder / "a.h5", {.stage = "example"});
        writer.create(all[0].spec);
        append(writer, all[0], 0, all[0].rows());
        CHECK_FALSE(std::filesystem::exists(folder / "a.h5"));
        CHECK(names_in(folder.path()).size() == 1);
    }
    CHECK(names_in(folder.path()).empty());
}

TEST_CASE("an artifact that is made again replaces the old one at once") {
    const TemporaryFolder folder;
    const ArtifactRecord old = write(folder / "a.h5", every_type(5));
    const ArtifactReader reader(folder / "a.h5", old.hash);
    const ArtifactRecord made = write(folder / "a.h5", every_type(6));
    CHECK(reader.rows("/letters") == 5);
    CHECK(reader.read<int32_t>("/letters").size() == 5);
    CHECK(ArtifactReader(folder / "a.h5", made.hash).rows("/letters") == 6);
    CHECK(names_in(folder.path()) == std::vector<std::string>{"a.h5"});
}

TEST_CASE("a folder that does not exist is an error before any work") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(ArtifactWriter(folder / "none" / "a.h5", {}), CreateError);
    CHECK_THROWS_WITH(ArtifactWriter(folder / "none" / "a.h5", {}),
                      Contains((folder / "none" / "a.h5").string()));
}

TEST_CASE("misuse of a writer is a bug, not a file with holes") {
    const TemporaryFolder folder;
    ArtifactWriter writer(folder / "a.h5", {});
    writer.create({.path = "/pairs", .type = ElementType::int32, .row_shape = {2}});
    const std::vector<int32_t> three{1, 2, 3};
    const std::vector<float> wrong{1, 2};
    CHECK_THROWS_AS(writer.append<int32_t>("/pairs", three), std::logic_error);
    CHECK_THROWS_AS(writer.append<float>("/pairs", wrong), std::logic_error);
    CHECK_THROWS_AS(writer.append<float>("/none", wrong), std::logic_error);
    CHECK_THROWS_AS(writer.create({.path = "/pairs"}), std::logic_error);
    for (const DatasetSpec& spec :
         {DatasetSpec{.path = "pairs"}, DatasetSpec{.path = "/"}, DatasetSpec{.path = "/a//b"},
          DatasetSpec{.path = "/a/"}, DatasetSpec{.path = "/a", .row_shape = {0}},
          DatasetSpec{.path = "/a", .type = ElementType::text, .row_shape = {2}}}) {
        CHECK_THROWS_AS(writer.create(spec), std::logic_error);
    }
}

TEST_CASE("a wrong name, type or row is an error that names file and dataset") {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.h5").string();
    const ArtifactReader reader(file, write(file, every_type(9)).hash);
    CHECK_FALSE(reader.contains("/none"));
    CHECK(reader.contains("/letters"));
    CHECK_THROWS_WITH(reader.rows("/none"), Contains(file) && Contains("/none"));
    CHECK_THROWS_WITH(reader.read<float>("/letters"),
                      Contains(file) && Contains("/letters in") && Contains("int32"));
    CHECK_THROWS_AS(reader.read<float>("/letters"), StoreError);
    CHECK_THROWS_AS(reader.read_texts("/letters"), StoreError);
    CHECK_THROWS_AS(reader.read_matrix_double("/letters"), StoreError);
    CHECK_THROWS_AS(reader.read<int32_t>("/letters", 5, 5), StoreError);
    CHECK_THROWS_AS(reader.read<int32_t>("/letters", -1, 1), StoreError);
    CHECK_THROWS_AS(reader.read<int32_t>("/letters", 1, std::numeric_limits<int64_t>::max()),
                    StoreError);
    CHECK(reader.read<int32_t>("/letters", 9, 0).empty());
}

TEST_CASE("an artifact of a newer format is refused, saying so") {
    const TemporaryFolder folder;
    ArtifactWriter writer(folder / "a.h5", {.stage = "example", .format_version = 2});
    const Digest hash = writer.close().hash;
    CHECK_THROWS_AS(ArtifactReader(folder / "a.h5", hash), StoreError);
    CHECK_THROWS_WITH(ArtifactReader(folder / "a.h5", hash),
                      Contains("made by a newer Kinetome (format 2, this one knows up to 1)"));
}

TEST_CASE("artifacts are written and read by several threads at the same time") {
    const TemporaryFolder folder;
    const std::vector<Data> all = every_type(5000);
    const ArtifactRecord expected = write(folder / "expected.h5", all);
    const ArtifactReader shared(folder / "expected.h5", expected.hash);
    std::vector<int> equal(4, 0);
    std::vector<std::thread> threads;
    for (size_t t = 0; t < equal.size(); ++t) {
        threads.emplace_back([&, t] {
            const auto path = folder / (std::to_string(t) + ".h5");
            const ArtifactRecord record = write(path, all, 100 + t);
            const ArtifactReader own(path, record.hash);
            equal[t] = record.hash == expected.hash;
            for (const Data& data : all) {
                equal[t] &= bytes_of(read(own, data)) == bytes_of(data);
                equal[t] &= bytes_of(read(shared, data)) == bytes_of(data);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(equal == std::vector<int>(4, 1));
}

TEST_CASE("compression has three names, and others are refused") {
    CHECK(parse_compression("none") == Compression::none);
    CHECK(parse_compression("gzip") == Compression::gzip);
    CHECK_THROWS_AS(parse_compression("zip"), UsageError);
    CHECK_THROWS_WITH(parse_compression("zip"), Contains("none, gzip or blosc"));
}
