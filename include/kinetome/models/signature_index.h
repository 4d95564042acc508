// An index of signatures (S2 §5.3): the sub-motions of a collection nearest to a query, at a cost
// that hardly grows with the collection.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/placed_signature.h"
#include "kinetome/models/signature_match.h"

namespace kinetome {

/// Lists of numbers of different lengths, one behind the other.
template <class Value>
struct ValueLists {
    std::vector<int64_t> first{0};  ///< list i is values [first[i], first[i + 1])
    std::vector<Value> values;

    int64_t size() const { return static_cast<int64_t>(first.size()) - 1; }
    std::span<const Value> operator[](int64_t list) const {
        const auto i = static_cast<size_t>(list);
        return std::span(values).subspan(static_cast<size_t>(first[i]),
                                         static_cast<size_t>(first[i + 1] - first[i]));
    }
};

/// A leaf and how far it is, mm per marker.
struct NearLeaf {
    int32_t leaf = 0;
    float distance = 0;
    bool operator==(const NearLeaf&) const = default;
};

struct SignatureIndexOptions {
    int32_t near_leaves = 128;  ///< listed for each leaf, itself among them, at most
    double reach = 200;         ///< mm per marker: farther leaves are not listed
};

struct SignatureSearchOptions {
    SignatureMatchOptions match;
    int64_t occurrences = 256;  ///< of near leaves that are looked up for each run of the query
    int64_t places = 100;       ///< at most, where the query is matched
    bool to_the_frame = true;   ///< pace: answers at the query's own pace are moved by frames
};

/// A sub-motion that is like the query.
struct IndexedMatch {
    int32_t clip = 0;
    SignatureMatch match;
    bool operator==(const IndexedMatch&) const = default;
};

struct MotionView;  // signature_moments.h

/// The k nearest, nearest first, then by clip and frame; those at the place of a nearer one left
/// out (is_same_place).
std::vector<IndexedMatch> nearest_matches(std::vector<IndexedMatch> matches, int64_t k,
                                          double overlap);

/// A search looks up, in an inverted index of the leaves, where the leaves of the query and those
/// near them occur; each occurrence speaks for the places where the query would answer it. At the
/// places that most of the query speaks for, it is matched (match_paces, match_runs). What is
/// looked up is bounded, so that a search takes as long in a large collection as in a small one,
/// but for the sum of what was said of each place.
class SignatureIndex {
  public:
    struct Parts {
        ValueLists<SignatureRun> clips;    ///< runs of each
        MatrixF positions;                 ///< runs × r, clip after clip
        int32_t stride = 1;                ///< of the samples
        MatrixF sample_positions;          ///< samples × r, clip after clip
        ValueLists<int32_t> occurrences;   ///< runs of each leaf, counted over all clips
        ValueLists<NearLeaf> near_leaves;  ///< of each leaf, nearest first
        double reach = 0;                  ///< mm per marker, of near leaves
    };

    /// Positions of all are along the same axes (signature_axes), samples at the same stride. The
    /// same for any number of threads. Throws std::invalid_argument for a leaf without a position.
    SignatureIndex(const std::vector<PlacedSignature>& clips, const MatrixF& leaf_positions,
                   const SignatureIndexOptions& options, int threads);
    /// Out of the parts() of another one. Throws std::invalid_argument when they do not fit.
    explicit SignatureIndex(Parts parts);

    const Parts& parts() const { return parts_; }
    std::span<const SignatureRun> signature(int32_t clip) const { return parts_.clips[clip]; }

    /// The k nearest matches, nearest first, then by clip and frame; no two at one place. A match
    /// by MatchRule::pace is a whole number of steps long, but where the query lies much nearer at
    /// its own pace: there it is to the frame, so that a motion of the index finds itself. A
    /// tolerance of 0 asks for exact matches (exact_matches), of which none is missed. Throws
    /// std::invalid_argument when the query's positions are of another shape than its runs and
    /// those of the index. The samples of a query may be nearer together than those of the index.
    std::vector<IndexedMatch> search(const PlacedSignature& query, int64_t k,
                                     const SignatureSearchOptions& options) const;

  private:
    std::vector<IndexedMatch> matches_by_pace(const PlacedSignature& query, int64_t k,
                                              SignatureSearchOptions options) const;
    std::vector<IndexedMatch> matches_by_runs(const PlacedSignature& query,
                                              const SignatureSearchOptions& options) const;
    std::vector<IndexedMatch> exact_matches(std::span<const SignatureRun> query) const;
    FrameSamples samples(int32_t clip) const;
    MotionView motion(int32_t clip) const;

    Parts parts_;
    std::vector<int32_t> clip_of_run_;
    std::vector<int64_t> first_sample_;  ///< by clip
};

}  // namespace kinetome
