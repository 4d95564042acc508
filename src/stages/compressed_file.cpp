#include "kinetome/stages/compressed_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "kinetome/base/digest.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/pack_fields.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/skeleton_packing.h"

namespace kinetome {
namespace {

constexpr std::string_view magic = "kinetome motion 1\n";
/// Behind the magic: the length and the hash of the packed head.
constexpr int64_t preamble = static_cast<int64_t>(magic.size() + 2 * sizeof(uint64_t));

void pack(Packer& out, const CompressedClip& clip) {
    pack_all(out, clip.name, clip.skeleton, clip.rate, clip.frames);
    pack_each(out, clip.blocks, [&](const CompressedBlock& block) {
        pack_all(out, block.offset, static_cast<int32_t>(block.bytes), block.hash);
    });
    kinetome::pack(out, clip.keys);
}

void unpack(Unpacker& in, CompressedClip& clip) {
    unpack_all(in, clip.name, clip.skeleton, clip.rate, clip.frames);
    unpack_each(in, clip.blocks, [&](CompressedBlock& block) {
        int32_t bytes = 0;
        unpack_all(in, block.offset, bytes, block.hash);
        block.bytes = bytes;
    });
    kinetome::unpack(in, clip.keys);
}

std::string packed_head(const CompressedHead& head) {
    Packer out;
    out.put(head.steps.coordinate).put(head.steps.place).put(head.steps.heading);
    out.put(head.blend.frames).put(head.block_frames);
    out.put(std::string_view(head.models.bytes()));
    out.put(static_cast<uint64_t>(head.skeletons.size()));
    for (const auto& skeleton : head.skeletons) pack(out, *skeleton);
    out.put(static_cast<uint64_t>(head.clips.size()));
    for (const CompressedClip& clip : head.clips) pack(out, clip);
    const PoseErrors& errors = head.errors;
    out.put(errors.rms).put(errors.mean).put(errors.share_95).put(errors.greatest);
    return out.take();
}

bool fits(const CompressedHead& head, const CompressedClip& clip) {
    if (clip.skeleton < 0 || clip.skeleton >= static_cast<int32_t>(head.skeletons.size())) {
        return false;
    }
    const Skeleton& skeleton = *head.skeletons[static_cast<size_t>(clip.skeleton)];
    const auto blocks = static_cast<int64_t>(clip.blocks.size());
    return clip.rate > 0 && clip.frames > 0 &&
           head.models.columns() == 3 * skeleton.joint_count() &&
           blocks == (clip.frames + head.block_frames - 1) / head.block_frames &&
           clip.keys.rows() == blocks + 1 && clip.keys.cols() == skeleton.dof_count() &&
           std::ranges::all_of(clip.blocks, [](const CompressedBlock& block) {
               return block.offset >= 0 && block.bytes >= 0;
           });
}

CompressedHead unpacked_head(std::string bytes) {
    Unpacker in(std::move(bytes));
    MotionSteps steps;
    for (double* step : {&steps.coordinate, &steps.place, &steps.heading}) unpack(in, *step);
    LeafBlend blend;
    unpack(in, blend.frames);
    const auto block_frames = in.get<int64_t>();
    CompressedHead head{steps, blend, block_frames, LeafModels(in.get_text()), {}, {}, {}};
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        Skeleton skeleton;
        unpack(in, skeleton);
        head.skeletons.push_back(std::make_shared<const Skeleton>(std::move(skeleton)));
    }
    for (auto left = in.get<uint64_t>(); left > 0; --left) unpack(in, head.clips.emplace_back());
    PoseErrors& errors = head.errors;
    for (double* error : {&errors.rms, &errors.mean, &errors.share_95, &errors.greatest}) {
        unpack(in, *error);
    }
    const bool sound = block_frames > 0 && blend.frames >= 0 &&
                       std::ranges::all_of(head.clips, [&](const CompressedClip& clip) {
                           return fits(head, clip);
                       });
    if (!sound) throw std::out_of_range("its head contradicts itself");
    return head;
}

StoreError damaged(const std::filesystem::path& path, std::string_view what) {
    return StoreError(fmt::format("{} cannot be read: {}", path_for_message(path.string()), what));
}

/// Bytes [first, first + count) of a file.
std::string read_bytes(const std::filesystem::path& path, int64_t first, int64_t count) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes(static_cast<size_t>(count), '\0');
    file.seekg(first);
    if (!file.read(bytes.data(), count)) throw damaged(path, "it ends too early");
    return bytes;
}

uint64_t hash_of(std::string_view bytes) {
    return digest_of(bytes).low;
}

}  // namespace

int64_t CompressedHead::frames() const {
    int64_t all = 0;
    for (const CompressedClip& clip : clips) all += clip.frames;
    return all;
}

double CompressedSize::ratio(const CompressedHead& head) const {
    const auto numbers = static_cast<double>(head.frames() * head.models.columns());
    return numbers * sizeof(float) / static_cast<double>(file);
}

CompressedSize write_compressed(const std::filesystem::path& path, const CompressedHead& head,
                                const std::string& blocks) {
    const std::string packed = packed_head(head);
    Packer lengths;
    lengths.put(static_cast<uint64_t>(packed.size())).put(hash_of(packed));
    write_file_atomically(path, std::string(magic) + lengths.bytes() + packed + blocks);
    return CompressedFile(path).size();
}

CompressedFile::CompressedFile(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code error;
    const auto bytes = static_cast<int64_t>(std::filesystem::file_size(path_, error));
    if (error) throw InputError::in_file(path_.string(), "cannot be read: " + error.message());
    if (bytes < preamble || read_bytes(path_, 0, std::ssize(magic)) != magic) {
        throw damaged(path_, "it is no compressed motion (kinetome compress makes such files)");
    }
    Unpacker lengths(read_bytes(path_, std::ssize(magic), preamble - std::ssize(magic)));
    const auto packed_bytes = lengths.get<uint64_t>();
    if (packed_bytes > static_cast<uint64_t>(bytes - preamble)) {
        throw damaged(path_, "it ends too early");
    }
    head_bytes_ = preamble + static_cast<int64_t>(packed_bytes);
    std::string packed = read_bytes(path_, preamble, static_cast<int64_t>(packed_bytes));
    if (hash_of(packed) != lengths.get<uint64_t>()) throw damaged(path_, "its head is damaged");
    try {
        head_ = unpacked_head(std::move(packed));
    } catch (const std::out_of_range& reason) {
        throw damaged(path_, reason.what());
    }
    size_.file = bytes;
    size_.models = static_cast<int64_t>(head_.models.bytes().size());
    size_.blocks = bytes - head_bytes_;
    size_.rest = head_bytes_ - size_.models;
}

const CompressedClip& CompressedFile::find(const std::string& clip) const {
    if (clip.empty() && head_.clips.size() == 1) return head_.clips.front();
    const auto found = std::ranges::find(head_.clips, clip, &CompressedClip::name);
    if (found != head_.clips.end()) return *found;
    std::vector<std::string> names;
    for (const CompressedClip& one : head_.clips) names.push_back(one.name);
    throw UsageError(fmt::format("--clip {}: {} holds {}", quote_for_message(clip),
                                 path_for_message(path_.string()), fmt::join(names, ", ")));
}

LeafFrames CompressedFile::read(const CompressedClip& clip, int64_t first, int64_t end) const {
    LeafFrames all{{}, MatrixD(0, head_.models.dimension()), MatrixD(0, 4)};
    for (int64_t b = first; b < end; ++b) {
        const CompressedBlock& block = clip.blocks[static_cast<size_t>(b)];
        const std::string bytes = read_bytes(path_, head_bytes_ + block.offset, block.bytes);
        const int64_t expected = std::min(head_.block_frames, clip.frames - b * head_.block_frames);
        try {
            if (hash_of(bytes) != block.hash) throw std::out_of_range("a block is damaged");
            const LeafFrames frames = decode_block(bytes, head_.models, head_.steps);
            if (std::ssize(frames.models) != expected) {
                throw std::out_of_range("a block has another length");
            }
            all.models.insert(all.models.end(), frames.models.begin(), frames.models.end());
            all.coordinates.conservativeResize(std::ssize(all.models), Eigen::NoChange);
            all.root.conservativeResize(std::ssize(all.models), Eigen::NoChange);
            all.coordinates.bottomRows(expected) = frames.coordinates;
            all.root.bottomRows(expected) = frames.root;
        } catch (const std::out_of_range& reason) {
            throw damaged(path_, reason.what());
        }
    }
    return all;
}

}  // namespace kinetome
