// A mixture fitted by several ranks is the one that a single process fits, bit for bit.
#include <catch2/catch.hpp>
#include <functional>

#include "kinetome/math/mixture.h"
#include "mixture_reference.h"
#include "support/thread_ranks.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

/// Groups of several sizes, one of them without rows.
PieceLayout some_layout() {
    std::vector<ClipExtent> clips;
    RandomStream random(3, "clips");
    for (int i = 0; i < 40; ++i) {
        const auto frames = int64_t(100 + random.below(900));
        clips.push_back({random(), frames, i % 7 == 0 ? 0 : frames});
    }
    clips[20] = {0, group_frames, 0};
    return layout_pieces(clips);
}

/// Rows that may be read inside the share of one rank alone, but for the start's sample.
class WatchedRows final : public RowSource {
  public:
    WatchedRows(const MatrixF& matrix, const PieceLayout& layout) : rows_(matrix, layout) {}
    int64_t columns() const override { return rows_.columns(); }
    const PieceLayout& layout() const override { return rows_.layout(); }
    RowBlock read(const RowRange& range) const override {
        int64_t most = most_;
        while (most < range.size() && !most_.compare_exchange_weak(most, range.size())) {
        }
        return RowBlock(MatrixF(rows_.read(range).view()));  // rows of its own, soon freed
    }
    int64_t most_read_at_once() const { return most_; }

  private:
    MatrixRows rows_;
    mutable std::atomic<int64_t> most_{0};
};

template <class Result>
std::vector<Result> on_ranks(int count, const std::function<Result(const Workers&)>& work) {
    std::vector<Result> results(static_cast<size_t>(count));
    run_as_ranks(count, [&](Communicator& ranks) {
        results[size_t(ranks.rank())] = work(Workers(1 + ranks.rank() % 2, &ranks));
    });
    return results;
}

}  // namespace

TEST_CASE("moments are the same at every rank") {
    const PieceLayout layout = some_layout();
    const MatrixF rows = wandering_rows(layout.rows(), 5, 1);
    const MatrixRows source(rows, layout);
    const Moments alone = moments_of(source, 1);
    for (const Moments& moments : on_ranks<Moments>(
             3, [&](const Workers& workers) { return moments_of(source, workers); })) {
        CHECK(moments.count == alone.count);
        CHECK(moments.mean == alone.mean);
        CHECK(moments.scatter == alone.scatter);
    }
}

TEST_CASE("a start drawn by several ranks is the one drawn by one") {
    const PieceLayout layout = some_layout();
    const MatrixF rows = wandering_rows(layout.rows(), 4, 2);
    const MatrixRows source(rows, layout);
    MixtureOptions options;
    for (const int64_t sample : {2'000'000, 9000, 5}) {
        options.start_sample = sample;
        const Mixture alone = start_mixture(source, 50, options, 1, 1);
        for (const int count : {2, 3, 9}) {  // the last: more ranks than blocks of the sample
            for (const Mixture& start : on_ranks<Mixture>(count, [&](const Workers& workers) {
                     return start_mixture(source, 50, options, 1, workers);
                 })) {
                CHECK(same_bits(start, alone));
            }
        }
    }
}

TEST_CASE("a fit on several ranks is that of one, and so is one resumed on another number") {
    const PieceLayout layout = some_layout();
    const MatrixF rows = wandering_rows(layout.rows(), 4, 3);
    const WatchedRows source(rows, layout);
    MixtureOptions options;
    options.max_iterations = 8;
    options.restarts = 2;
    std::vector<MixtureProgress> reports;
    const MixtureFit alone =
        fit_mixture(source, 30, options, 2, {},
                    [&](const MixtureProgress& progress) { reports.push_back(progress); });
    const auto same_as_alone = [&](const MixtureFit& fit) {
        return same_bits(fit.model, alone.model) && fit.history == alone.history &&
               fit.mean_log_likelihood == alone.mean_log_likelihood;
    };
    for (const int count : {2, 3, 9}) {
        for (const MixtureFit& fit : on_ranks<MixtureFit>(count, [&](const Workers& workers) {
                 return fit_mixture(source, 30, options, workers);
             })) {
            CHECK(same_as_alone(fit));
        }
    }
    const auto middle = unpacked<MixtureProgress>(packed(reports.at(reports.size() / 2)));
    for (const MixtureFit& fit : on_ranks<MixtureFit>(3, [&](const Workers& workers) {
             return fit_mixture(source, 30, options, workers, {}, {}, &middle);
         })) {
        CHECK(same_as_alone(fit));
    }
    CHECK(source.most_read_at_once() < 2 * piece_frames);  // never the whole matrix
}

TEST_CASE("letters come in row order, whichever rank found them") {
    const PieceLayout layout = some_layout();
    const MatrixF rows = scattered_rows(layout.rows(), 3, 4);
    const MatrixRows source(rows, layout);
    const Mixture model = random_mixture(rows, 20, 0.3, 1, 5);
    const auto alone = likeliest_clusters(model, source, 1);
    for (const int count : {2, 3, 60}) {
        for (const auto& letters :
             on_ranks<std::vector<int32_t>>(count, [&](const Workers& workers) {
                 return likeliest_clusters(model, source, workers);
             })) {
            CHECK(letters == alone);
        }
    }
}
