#include "kinetome/run/ledger.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"

using namespace kinetome;

namespace {

Receipt sample_receipt() {
    Receipt receipt;
    receipt.stage = "frames";
    receipt.shard = "0123456789abcdef";
    receipt.key.add("format", "1").add("option z", "9").add("option a", "1");
    receipt.file = {
        "frames-0123456789abcdef.h5", 4711, digest_of("file"), {{"/c/x", digest_of("x")}}};
    receipt.cost = {1.25, 2.5, 1u << 30};
    ClipOutcome bad;
    bad.clip = "a \"quoted\"\n\xff name";
    bad.quarantined = "x.amc:7: expected a number, found 'z'";
    ClipOutcome good;
    good.clip = "02_01";
    good.frames = 343;
    good.rate = 120;
    good.clip_class = "31j62d-deadbeef";
    good.capabilities = {"angles", "markers"};
    good.warnings = {"source rate is below the analysis rate"};
    receipt.clips = {bad, good};
    return receipt;
}

}  // namespace

TEST_CASE("a receipt survives being written, whatever bytes a clip's name has", "[ledger]") {
    const Receipt receipt = sample_receipt();
    const Receipt back = parse_receipt(write_receipt(receipt), "r.json");
    CHECK(back.stage == receipt.stage);
    CHECK(back.shard == receipt.shard);
    CHECK(back.key.digest() == receipt.key.digest());
    CHECK(back.key.parts() == receipt.key.parts());
    CHECK(back.file == receipt.file);
    CHECK(back.cost.seconds == receipt.cost.seconds);
    CHECK(back.cost.peak_bytes == receipt.cost.peak_bytes);
    REQUIRE(back.clips.size() == 2);
    CHECK(back.clips[0].clip == receipt.clips[0].clip);
    CHECK(back.clips[0].quarantined == receipt.clips[0].quarantined);
    CHECK(back.clips[1].frames == 343);
    CHECK(back.clips[1].capabilities == receipt.clips[1].capabilities);
    CHECK(back.clips[1].warnings == receipt.clips[1].warnings);
}

TEST_CASE("a receipt cut short is refused, naming the file", "[ledger]") {
    const std::string text = write_receipt(sample_receipt());
    for (size_t length = 0; length + 2 < text.size(); length += 7) {
        CHECK_THROWS_AS(parse_receipt(text.substr(0, length), "r.json"), StoreError);
    }
    CHECK_THROWS_WITH(parse_receipt("{}", "folder/r.json"), Catch::Contains("folder/r.json"));
}

TEST_CASE("any flipped bit of a ledger is found by the ledger itself", "[ledger]") {
    Ledger ledger;
    ledger.version = "1.2.3";
    ledger.receipts = {sample_receipt()};
    ledger.receipts[0].cost.seconds = 1e-5;  // 1E-5 is the same number, one bit away
    ledger.texts = {{"catalog.json", digest_of("catalog")}};
    const std::string text = write_ledger(ledger);
    REQUIRE(parse_ledger(text, "ledger.json").receipts.size() == 1);
    CHECK(parse_ledger(text, "ledger.json").texts == ledger.texts);
    for (size_t i = 0; i < 8 * text.size(); ++i) {
        std::string damaged = text;
        damaged[i / 8] = static_cast<char>(damaged[i / 8] ^ (1 << i % 8));
        bool refused = false;
        try {
            parse_ledger(damaged, "ledger.json");
        } catch (const StoreError&) {
            refused = true;
        }
        if (!refused) FAIL("bit " << i << " of: " << damaged);
    }
}
