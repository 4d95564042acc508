#include "kinetome/base/digest.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/random.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

std::string random_bytes(size_t size) {
    RandomStream random(1, "bytes");
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.below(256));
    return bytes;
}

}  // namespace

TEST_CASE("digests are those that xxh128sum prints, so that a store can be checked without us") {
    CHECK(digest_of("").hex() == "99aa06d3014798d86001c324468d497f");
    CHECK(digest_of("abc").hex() == "06b05ab6733a618578af5f94892f3950");
    CHECK(hash_name("") == 0x2d06800538d394c2);
}

TEST_CASE("how bytes are cut into updates does not change a digest") {
    const std::string bytes = random_bytes(300'000);
    RandomStream random(2, "cuts");
    for (const uint64_t longest : {7, 300, 5000, 200'000}) {
        Hasher hasher;
        for (size_t first = 0; first < bytes.size();) {
            const size_t size = std::min<size_t>(random.below(longest), bytes.size() - first);
            hasher.bytes(bytes.data() + first, size);
            first += size;
        }
        CHECK(hasher.finish() == digest_of(bytes));
    }
}

TEST_CASE("texts are hashed with their lengths: moving a letter to the next text shows") {
    CHECK(Hasher().text("ab").text("c").finish() != Hasher().text("a").text("bc").finish());
    CHECK(Hasher().text("").text("a").finish() != Hasher().text("a").text("").finish());
}

TEST_CASE("one altered bit anywhere alters the digest") {
    std::string bytes = random_bytes(300);
    std::set<Digest> seen{digest_of(bytes)};
    for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        const auto mask = static_cast<char>(1 << (bit % 8));
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ mask);
        seen.insert(digest_of(bytes));
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ mask);
    }
    CHECK(seen.size() == 8 * bytes.size() + 1);
}

TEST_CASE("asking for the digest does not end the hashing") {
    Hasher hasher;
    hasher.bytes("ab", 2);
    CHECK(hasher.finish() == digest_of("ab"));
    CHECK(hasher.bytes("c", 1).finish() == digest_of("abc"));
}

TEST_CASE("a digest survives being written as text, leading zeros too") {
    for (const Digest digest : {Digest{1, 2}, Digest{0, 0}, Digest{~uint64_t{0}, 1}}) {
        CHECK(digest.hex().size() == 32);
        CHECK(Digest::from_hex(digest.hex()) == digest);
    }
}

TEST_CASE("text that is not a digest is refused") {
    const std::string good = digest_of("abc").hex();
    for (const std::string& bad :
         {std::string(), good.substr(1), good + "0", "-" + good.substr(1), "g" + good.substr(1),
          good.substr(0, 31) + " ", " " + good.substr(1), "0x" + good.substr(2)}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(Digest::from_hex(bad), StoreError);
    }
}

TEST_CASE("a file larger than a read buffer has the digest of its bytes") {
    const TemporaryFolder folder;
    const std::string bytes = random_bytes((size_t{5} << 19) + 13);
    uint64_t size = 0;
    CHECK(digest_file(folder.write("large", bytes), &size) == digest_of(bytes));
    CHECK(size == bytes.size());
    CHECK(digest_file(folder.write("empty", ""), &size) == digest_of(""));
    CHECK(size == 0);
}

TEST_CASE("a missing file and a folder have no digest") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(digest_file(folder / "missing"), StoreError);
    CHECK_THROWS_AS(digest_file(folder.path()), StoreError);
}

TEST_CASE("clips' names do not share hashes") {
    std::set<uint64_t> hashes;
    for (int i = 0; i < 10'000; ++i) hashes.insert(hash_name("subject/take_" + std::to_string(i)));
    CHECK(hashes.size() == 10'000);
}
