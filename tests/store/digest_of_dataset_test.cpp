#include <catch2/catch.hpp>
#include <set>

#include "artifact_example.h"
#include "support/temporary_folder.h"

using namespace kinetome;
using namespace artifact_example;

namespace {

Digest digest_in_memory(const Data& data) {
    DatasetDigest digest(data.spec);
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
            if constexpr (std::is_same_v<T, std::string>) {
                digest.texts(values);
            } else {
                digest.rows(values.data(), static_cast<int64_t>(data.rows()));
            }
        },
        data.values);
    return digest.finish();
}

/// The least change of one value: its lowest bit, or a text's last letter.
void alter(Data& data, size_t index) {
    std::visit(
        [&]<class T>(std::vector<T>& values) {
            if constexpr (std::is_same_v<T, std::string>) {
                values[index].back() ^= 1;
            } else {
                reinterpret_cast<unsigned char&>(values[index]) ^= 1;
            }
        },
        data.values);
}

}  // namespace

TEST_CASE("altering any one value of a dataset alters its digest, for every type") {
    for (const Data& original : every_type(9)) {
        INFO(original.spec.path);
        std::set<Digest> digests{digest_in_memory(original)};
        for (size_t i = 0; i < original.size(); ++i) {
            Data altered = original;
            alter(altered, i);
            digests.insert(digest_in_memory(altered));
        }
        CHECK(digests.size() == original.size() + 1);
    }
}

TEST_CASE("a digest tells the order of rows, and one row more or less") {
    const Data original = data<int32_t>("/letters", {}, 9);
    Data swapped = original;
    auto& values = std::get<std::vector<int32_t>>(swapped.values);
    std::swap(values[3], values[4]);
    Data longer = original;
    std::get<std::vector<int32_t>>(longer.values).push_back(0);
    const std::set<Digest> digests{digest_in_memory(original), digest_in_memory(swapped),
                                   digest_in_memory(longer)};
    CHECK(digests.size() == 3);
}

TEST_CASE("a digest tells where one text ends and the next begins") {
    DatasetSpec spec{.path = "/names", .type = ElementType::text};
    std::set<Digest> digests;
    for (const std::vector<std::string>& texts :
         {std::vector<std::string>{"ab", "c"}, {"a", "bc"}, {"abc"}, {"abc", ""}, {"", "abc"}}) {
        DatasetDigest digest(spec);
        digest.texts(texts);
        digests.insert(digest.finish());
    }
    CHECK(digests.size() == 5);
}

TEST_CASE("equal bytes of another dataset, type or shape have another digest") {
    const std::vector<uint64_t> zeros(6, 0);
    std::set<Digest> digests;
    const std::vector<DatasetSpec> specs{
        {.path = "/a", .type = ElementType::uint64, .row_shape = {6}},
        {.path = "/b", .type = ElementType::uint64, .row_shape = {6}},
        {.path = "/a", .type = ElementType::int64, .row_shape = {6}},
        {.path = "/a", .type = ElementType::float64, .row_shape = {6}},
        {.path = "/a", .type = ElementType::uint64, .row_shape = {2, 3}},
        {.path = "/a", .type = ElementType::uint64, .row_shape = {3, 2}}};
    for (const DatasetSpec& spec : specs) {
        DatasetDigest digest(spec);
        digest.rows(zeros.data(), 1);
        digests.insert(digest.finish());
    }
    CHECK(digests.size() == specs.size());
}

TEST_CASE("writer, reader and memory agree on a dataset's digest, whatever the compression") {
    const TemporaryFolder folder;
    const std::vector<Data> all = every_type(5000);
    for (const Compression compression : {Compression::none, Compression::gzip}) {
        const ArtifactRecord record = write(folder / "a.h5", all, 77, compression);
        const ArtifactReader reader(folder / "a.h5", record.hash);
        REQUIRE(record.datasets.size() == all.size());
        for (const Data& data : all) {
            INFO(data.spec.path);
            DatasetDigest read_again(reader.spec(data.spec.path));
            reader.digest_rows(data.spec.path, read_again);
            CHECK(record.datasets.at(data.spec.path) == digest_in_memory(data));
            CHECK(read_again.finish() == digest_in_memory(data));
        }
    }
}

TEST_CASE("shards, fed one after another, have the digest of the whole") {
    const TemporaryFolder folder;
    const std::vector<Data> all = every_type(5000);
    // The second shard is empty; the text columns differ in width.
    const std::vector<size_t> cuts{0, 3, 3, 4096, 5000};
    std::vector<ArtifactReader> shards;
    for (size_t s = 0; s + 1 < cuts.size(); ++s) {
        const auto path = folder / (std::to_string(s) + ".h5");
        ArtifactWriter writer(path, {.stage = "example"});
        for (const Data& data : all) {
            writer.create(data.spec);
            append(writer, data, cuts[s], cuts[s + 1]);
        }
        const Digest hash = writer.close().hash;
        shards.emplace_back(path, hash);
    }
    for (const Data& data : all) {
        INFO(data.spec.path);
        DatasetDigest digest(data.spec);
        for (const ArtifactReader& shard : shards) shard.digest_rows(data.spec.path, digest);
        CHECK(digest.finish() == digest_in_memory(data));
    }
}
