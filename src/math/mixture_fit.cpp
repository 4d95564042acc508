#include <stdexcept>
#include <string>
#include <utility>

#include "kinetome/math/mixture.h"
#include "mixture_start.h"

namespace kinetome {
namespace {

/// The loop of fit_mixture: what stays the same from one iteration to the next.
class Fitter {
  public:
    Fitter(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
           const Workers& workers, const StopToken& stop,
           const std::function<void(const MixtureProgress&)>& report)
        : rows_(rows),
          clusters_(clusters),
          options_(options),
          workers_(workers),
          stop_(stop),
          report_(report),
          least_variance_(checked_least_variance(rows, options, workers)) {}

    MixtureFit run(MixtureProgress progress) const {
        for (;;) {
            while (!finished(progress)) {
                stop_.check();
                iterate(progress);
                if (report_) report_(progress);
            }
            stop_.check();
            MixtureFit best = better_of(std::move(progress.best), close(progress));
            if (progress.restart + 1 >= options_.restarts) return best;
            progress = start(progress.restart + 1, std::move(best));
        }
    }

    MixtureProgress start(int restart, MixtureFit best) const {
        MixtureProgress progress;
        progress.restart = restart;
        progress.best = std::move(best);
        progress.model =
            start_mixture(rows_, clusters_, options_, least_variance_, restart, workers_);
        return progress;
    }

  private:
    bool finished(const MixtureProgress& progress) const {
        return progress.converged || progress.iteration >= options_.max_iterations;
    }

    void iterate(MixtureProgress& progress) const {
        const MixtureSums sums = accumulate(progress.model, rows_, workers_);
        progress.mean_log_likelihood = sums.mean_log_likelihood();
        progress.converged =
            !progress.history.empty() &&
            progress.mean_log_likelihood - progress.history.back() < options_.min_gain;
        progress.history.push_back(progress.mean_log_likelihood);
        progress.model = estimate(progress.model, sums, least_variance_);
        ++progress.iteration;
    }

    MixtureFit close(MixtureProgress& progress) const {
        const MixtureSums sums = accumulate(progress.model, rows_, workers_);
        return {std::move(progress.model), sums.mean_log_likelihood(), std::move(progress.history),
                progress.converged};
    }

    static MixtureFit better_of(MixtureFit earlier, MixtureFit later) {
        const bool replace = earlier.model.clusters() == 0 ||
                             later.mean_log_likelihood > earlier.mean_log_likelihood;
        return replace ? std::move(later) : std::move(earlier);
    }

    const RowSource& rows_;
    int64_t clusters_;
    const MixtureOptions& options_;
    const Workers& workers_;
    const StopToken& stop_;
    const std::function<void(const MixtureProgress&)>& report_;
    double least_variance_;
};

}  // namespace

MixtureFit fit_mixture(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
                       const Workers& workers, const StopToken& stop,
                       const std::function<void(const MixtureProgress&)>& report,
                       const MixtureProgress* resume_from) {
    if (options.max_iterations < 1 || options.restarts < 1) {
        throw std::invalid_argument("a mixture needs at least one iteration and one start");
    }
    const Fitter fitter(rows, clusters, options, workers, stop, report);
    return fitter.run(resume_from ? *resume_from : fitter.start(0, {}));
}

}  // namespace kinetome
