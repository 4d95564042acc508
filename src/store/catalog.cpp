#include "kinetome/store/catalog.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/store/json_text.h"

namespace kinetome {
namespace {

constexpr int catalog_format = 1;
constexpr std::string_view what = "a catalog";

Json to_json(const CatalogClip& clip) {
    Json skipped = Json::object();
    for (const auto& [stage, reason] : clip.skipped) skipped[stage] = reason;
    return {{"name", clip.name},
            {"id", clip.id},
            {"source", clip.source},
            {"content", clip.content.hex()},
            {"skeleton_source", clip.skeleton_source},
            {"claimed_frames", clip.claimed_frames},
            {"frames", clip.frames},
            {"rate", clip.rate},
            {"class", clip.clip_class},
            {"capabilities", clip.capabilities},
            {"shard", clip.shard},
            {"state", clip.indexed() ? "indexed" : "quarantined"},
            {"reason", clip.quarantined},
            {"skipped", skipped},
            {"warnings", clip.warnings}};
}

Digest digest_from_json(const Json& json, const std::filesystem::path& path) {
    try {
        return Digest::from_hex(json.get_ref<const std::string&>());
    } catch (const StoreError& error) {
        throw StoreError(path.string() + ": " + error.what());
    }
}

CatalogClip clip_from_json(const Json& json, const std::filesystem::path& path) {
    CatalogClip clip;
    json.at("name").get_to(clip.name);
    json.at("id").get_to(clip.id);
    json.at("source").get_to(clip.source);
    clip.content = digest_from_json(json.at("content"), path);
    json.at("skeleton_source").get_to(clip.skeleton_source);
    json.at("claimed_frames").get_to(clip.claimed_frames);
    json.at("frames").get_to(clip.frames);
    json.at("rate").get_to(clip.rate);
    json.at("class").get_to(clip.clip_class);
    json.at("capabilities").get_to(clip.capabilities);
    json.at("shard").get_to(clip.shard);
    json.at("reason").get_to(clip.quarantined);
    for (const auto& [stage, reason] : json.at("skipped").items()) {
        clip.skipped.emplace(stage, reason.get<std::string>());
    }
    json.at("warnings").get_to(clip.warnings);
    return clip;
}

}  // namespace

int64_t clip_id(std::string_view name) {
    return static_cast<int64_t>(hash_name(name) >> 11);
}

int64_t Catalog::indexed() const {
    return std::count_if(clips.begin(), clips.end(),
                         [](const auto& clip) { return clip.indexed(); });
}

int64_t Catalog::quarantined() const {
    return static_cast<int64_t>(clips.size()) - indexed();
}

int64_t Catalog::frames() const {
    int64_t total = 0;
    for (const CatalogClip& clip : clips) total += clip.frames;
    return total;
}

std::string write_catalog(const Catalog& catalog) {
    std::string text = fmt::format("{{\"kinetome_format\":{},\"corpus\":{},\n\"clips\":[",
                                   catalog_format, dump_json(catalog.corpus, -1));
    for (const CatalogClip& clip : catalog.clips) {
        text += &clip == catalog.clips.data() ? "\n" : ",\n";
        text += dump_json(to_json(clip), -1);
    }
    text += "\n],\n\"removed\":" + dump_json(catalog.removed, -1) + "}\n";
    return text;
}

Catalog parse_catalog(std::string_view json, const std::filesystem::path& path) {
    const Json document = parse_json(json, path, what);
    return convert_json(document, path, what, [&](const Json& top) {
        const auto format = top.at("kinetome_format").get<int>();
        if (format > catalog_format) {
            throw StoreError(
                fmt::format("{} was made by a newer Kinetome (format {}, this one knows up to {}); "
                            "use that one",
                            path.string(), format, catalog_format));
        }
        Catalog catalog;
        top.at("corpus").get_to(catalog.corpus);
        for (const Json& clip : top.at("clips"))
            catalog.clips.push_back(clip_from_json(clip, path));
        top.at("removed").get_to(catalog.removed);
        return catalog;
    });
}

}  // namespace kinetome
