#include "kinetome/models/bundle_ends.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "kinetome/base/random.h"

namespace kinetome {
namespace {

/// Mean, squares and count of one of the three terms of Eq. 6: enough for its variance.
struct Spread {
    VectorD sum;
    double squares = 0;

    void add(const VectorD& value, double sign) {
        sum += sign * value;
        squares += sign * value.squaredNorm();
    }
    double variance(double count) const {
        return std::max(0.0, (squares - sum.squaredNorm() / count) / count);
    }
};

/// What Eq. 6 needs of a bundle.
struct BundleSums {
    double members = 0;
    Spread starts, ends, lengths;

    double score() const {
        return starts.variance(members) + ends.variance(members) + lengths.variance(members);
    }
};

constexpr int32_t none = -1;

/// A letter of J, and what depends on its frame.
struct End {
    int32_t letter = 0;
    Eigen::Index first_row = 0;                        ///< of F(letter), in the poses
    int32_t begins_bundle = none, begins_last = none;  ///< the member that begins here
    int32_t ends_bundle = none, ends_first = none;     ///< the member that ends here
};

class EndSearch {
  public:
    EndSearch(const MotionString& string, std::span<const SubstringBundle> bundles,
              std::span<const int32_t> letters, const MatrixFView& poses)
        : string_(string), poses_(poses), number_of_(static_cast<size_t>(string.size()), none) {
        for (int32_t j = 0; j < string.size(); ++j) {
            frames_.push_back(static_cast<int32_t>(string.mean_frame(j)));
        }
        Eigen::Index row = 0;
        for (const int32_t letter : letters) {
            number_of_[static_cast<size_t>(letter)] = static_cast<int32_t>(ends_.size());
            ends_.push_back({letter, row});
            row += string.end_frame[static_cast<size_t>(letter)] -
                   string.first_frame[static_cast<size_t>(letter)];
        }
        if (row != poses.rows())
            throw std::invalid_argument("one pose is needed for each frame of each bundle's ends");
        for (const SubstringBundle& bundle : bundles) {
            if (!bundle.is_degenerate()) enter(bundle);
        }
    }

    BundleEnds search(const BundleEndOptions& options) {
        BundleEnds result;
        result.first_score = score();
        bool gained = true;
        while (gained && result.sweeps < options.sweeps) gained = sweep(options, ++result.sweeps);
        result.score = score();
        result.frames = std::move(frames_);
        return result;
    }

  private:
    void enter(const SubstringBundle& bundle) {
        const auto number = static_cast<int32_t>(sums_.size());
        const VectorD zero = VectorD::Zero(poses_.cols()), zero_length = VectorD::Zero(1);
        sums_.push_back({static_cast<double>(bundle.height()), {zero}, {zero}, {zero_length}});
        for (const Substring& member : bundle.members) {
            End& begin = end_at(member.first);
            begin.begins_bundle = number;
            begin.begins_last = member.last;
            End& end = end_at(member.last);
            end.ends_bundle = number;
            end.ends_first = member.first;
            BundleSums& sums = sums_.back();
            sums.starts.add(pose(begin), 1);
            sums.ends.add(pose(end), 1);
            sums.lengths.add(length(member.first, member.last), 1);
        }
    }

    End& end_at(int32_t letter) {
        const int32_t number = number_of_[static_cast<size_t>(letter)];
        if (number == none)
            throw std::invalid_argument("a bundle ends at a letter for which no poses were given");
        return ends_[static_cast<size_t>(number)];
    }
    int32_t& frame_of(int32_t letter) { return frames_[static_cast<size_t>(letter)]; }
    VectorD pose(const End& end) {
        const int32_t first = string_.first_frame[static_cast<size_t>(end.letter)];
        return poses_.row(end.first_row + frame_of(end.letter) - first).transpose().cast<double>();
    }
    VectorD length(int32_t first, int32_t last) {
        return VectorD::Constant(1, frame_of(last) - frame_of(first));
    }

    /// Adds what depends on the end's frame to the sums, or takes it away.
    void account(const End& end, double sign) {
        const VectorD here = pose(end);
        if (end.begins_bundle != none) {
            BundleSums& sums = sums_[static_cast<size_t>(end.begins_bundle)];
            sums.starts.add(here, sign);
            sums.lengths.add(length(end.letter, end.begins_last), sign);
        }
        if (end.ends_bundle != none) {
            BundleSums& sums = sums_[static_cast<size_t>(end.ends_bundle)];
            sums.ends.add(here, sign);
            sums.lengths.add(length(end.ends_first, end.letter), sign);
        }
    }

    /// Of the bundles that the end's frame matters to.
    double score_at(const End& end) const {
        double sum = 0;
        if (end.begins_bundle != none) sum += sums_[static_cast<size_t>(end.begins_bundle)].score();
        if (end.ends_bundle != none && end.ends_bundle != end.begins_bundle)
            sum += sums_[static_cast<size_t>(end.ends_bundle)].score();
        return sum;
    }

    double score() const {
        double sum = 0;
        for (const BundleSums& sums : sums_) sum += sums.score();
        return sum;
    }

    /// Every end once, in random order. Whether any was moved.
    bool sweep(const BundleEndOptions& options, int32_t number) {
        std::vector<size_t> order(ends_.size());
        std::iota(order.begin(), order.end(), size_t{0});
        RandomStream random(options.seed, "bundle ends", static_cast<uint64_t>(number));
        for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
        bool moved = false;
        for (const size_t i : order) moved |= improve(ends_[i]);
        return moved;
    }

    /// Direct search in F(j); the first of equally good frames, the old one if none is better.
    bool improve(const End& end) {
        // Gains of less than this are rounding.
        constexpr double least_gain = 1e-9;
        const auto letter = static_cast<size_t>(end.letter);
        const int32_t before = frame_of(end.letter);
        int32_t best = before;
        double least = score_at(end) * (1 - least_gain);
        account(end, -1);
        for (int32_t frame = string_.first_frame[letter]; frame < string_.end_frame[letter];
             ++frame) {
            if (frame == before) continue;
            frame_of(end.letter) = frame;
            account(end, 1);
            const double score_here = score_at(end);
            account(end, -1);
            if (score_here < least) {
                least = score_here;
                best = frame;
            }
        }
        frame_of(end.letter) = best;
        account(end, 1);
        return best != before;
    }

    const MotionString& string_;
    const MatrixFView poses_;
    std::vector<int32_t> frames_;     ///< f(j), by letter
    std::vector<int32_t> number_of_;  ///< by letter, in ends_
    std::vector<End> ends_;
    std::vector<BundleSums> sums_;
};

}  // namespace

std::vector<int32_t> bundle_end_letters(std::span<const SubstringBundle> bundles) {
    std::vector<int32_t> letters;
    for (const SubstringBundle& bundle : bundles) {
        if (bundle.is_degenerate()) continue;
        for (const Substring& member : bundle.members) {
            letters.insert(letters.end(), {member.first, member.last});
        }
    }
    std::ranges::sort(letters);
    const auto rest = std::ranges::unique(letters);
    letters.erase(rest.begin(), rest.end());
    return letters;
}

BundleEnds find_bundle_ends(const MotionString& string, std::span<const SubstringBundle> bundles,
                            std::span<const int32_t> letters, const MatrixFView& poses,
                            const BundleEndOptions& options) {
    return EndSearch(string, bundles, letters, poses).search(options);
}

}  // namespace kinetome
