#include "kinetome/run/ledger.h"

#include "kinetome/base/error.h"
#include "kinetome/store/json_text.h"

namespace kinetome {
namespace {

Json to_json(const ClipOutcome& clip) {
    Json json = {{"clip", clip.clip}};
    if (!clip.quarantined.empty()) json["quarantined"] = clip.quarantined;
    if (!clip.skipped.empty()) json["skipped"] = clip.skipped;
    if (clip.frames) json["frames"] = clip.frames;
    if (clip.rate > 0) json["rate"] = clip.rate;
    if (!clip.clip_class.empty()) json["class"] = clip.clip_class;
    if (!clip.capabilities.empty()) json["capabilities"] = clip.capabilities;
    if (!clip.warnings.empty()) json["warnings"] = clip.warnings;
    return json;
}

ClipOutcome clip_from(const Json& json) {
    ClipOutcome clip;
    clip.clip = json.at("clip");
    clip.quarantined = json.value("quarantined", "");
    clip.skipped = json.value("skipped", "");
    clip.frames = json.value("frames", int64_t{0});
    clip.rate = json.value("rate", 0.0);
    clip.clip_class = json.value("class", "");
    clip.capabilities = json.value("capabilities", std::vector<std::string>{});
    clip.warnings = json.value("warnings", std::vector<std::string>{});
    return clip;
}

Json to_json(const Receipt& receipt) {
    Json key = Json::object();
    for (const auto& [name, value] : receipt.key.parts()) key[name] = value;
    Json datasets = Json::object();
    for (const auto& [path, digest] : receipt.file.datasets) datasets[path] = digest.hex();
    Json clips = Json::array();
    for (const ClipOutcome& clip : receipt.clips) clips.push_back(to_json(clip));
    return {{"stage", receipt.stage},
            {"shard", receipt.shard},
            {"file", receipt.file.file_name},
            {"bytes", receipt.file.bytes},
            {"hash", receipt.file.hash.hex()},
            {"key", receipt.key.digest().hex()},
            {"key_parts", key},
            {"digests", datasets},
            {"seconds", receipt.cost.seconds},
            {"cpu_seconds", receipt.cost.cpu_seconds},
            {"peak_bytes", receipt.cost.peak_bytes},
            {"clips", clips}};
}

Receipt receipt_from(const Json& json) {
    Receipt receipt;
    receipt.stage = json.at("stage");
    receipt.shard = json.at("shard");
    receipt.file.file_name = json.at("file");
    receipt.file.bytes = json.at("bytes");
    receipt.file.hash = Digest::from_hex(json.at("hash").get<std::string>());
    std::vector<StageKey::Part> parts;
    for (const auto& [name, value] : json.at("key_parts").items()) parts.emplace_back(name, value);
    receipt.key = StageKey(std::move(parts));
    for (const auto& [path, digest] : json.at("digests").items()) {
        receipt.file.datasets[path] = Digest::from_hex(digest.get<std::string>());
    }
    receipt.cost = {json.at("seconds"), json.at("cpu_seconds"), json.at("peak_bytes")};
    for (const Json& clip : json.at("clips")) receipt.clips.push_back(clip_from(clip));
    return receipt;
}

std::string text_of(const Json& json) {
    return dump_json(json, 1) + "\n";
}

}  // namespace

std::string write_receipt(const Receipt& receipt) {
    return text_of(to_json(receipt));
}

Receipt parse_receipt(std::string_view json, const std::filesystem::path& path) {
    return convert_json(parse_json(json, path, "a receipt"), path, "a receipt", receipt_from);
}

const Receipt* Ledger::find(std::string_view file_name) const {
    for (const Receipt& receipt : receipts) {
        if (receipt.file.file_name == file_name) return &receipt;
    }
    return nullptr;
}

std::vector<const Receipt*> Ledger::of_stage(std::string_view stage) const {
    std::vector<const Receipt*> found;
    for (const Receipt& receipt : receipts) {
        if (receipt.stage == stage) found.push_back(&receipt);
    }
    return found;
}

std::string write_ledger(const Ledger& ledger) {
    Json receipts = Json::array();
    for (const Receipt& receipt : ledger.receipts) receipts.push_back(to_json(receipt));
    Json texts = Json::object();
    for (const auto& [name, hash] : ledger.texts) texts[name] = hash.hex();
    const Json body = {{"version", ledger.version}, {"receipts", receipts}, {"texts", texts}};
    const std::string hash = digest_of(dump_json(body, -1)).hex();
    return text_of({{"hash", hash}, {"ledger", body}});
}

Ledger parse_ledger(std::string_view json, const std::filesystem::path& path) {
    const auto ledger_from = [&](const Json& whole) {
        const Json& body = whole.at("ledger");
        // The text counts too: 1e-5 and 1E-5 are one number, but only one of them was written.
        if (whole.at("hash") != digest_of(dump_json(body, -1)).hex() || json != text_of(whole)) {
            throw DamagedError(path.string() + ": the ledger does not match its own hash: damaged");
        }
        Ledger ledger;
        ledger.version = body.at("version");
        for (const Json& receipt : body.at("receipts")) {
            ledger.receipts.push_back(receipt_from(receipt));
        }
        for (const auto& [name, hash] : body.at("texts").items()) {
            ledger.texts[name] = Digest::from_hex(hash.get<std::string>());
        }
        return ledger;
    };
    return convert_json(parse_json(json, path, "a ledger"), path, "a ledger", ledger_from);
}

}  // namespace kinetome
