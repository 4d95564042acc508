// A mixture, its sums and how far its fit is, as bytes: between ranks and in checkpoints.
#include "kinetome/math/mixture.h"

namespace kinetome {

void pack(Packer& out, const Mixture& mixture) {
    pack(out, mixture.means);
    pack(out, mixture.variances);
    pack(out, mixture.weights);
}

void unpack(Unpacker& in, Mixture& mixture) {
    unpack(in, mixture.means);
    unpack(in, mixture.variances);
    unpack(in, mixture.weights);
}

void pack(Packer& out, const MixtureSums& sums) {
    out.put(sums.rows).put(sums.log_likelihood);
    pack(out, sums.responsibility);
    pack(out, sums.offset);
    pack(out, sums.squared);
}

void unpack(Unpacker& in, MixtureSums& sums) {
    sums.rows = in.get<int64_t>();
    sums.log_likelihood = in.get<double>();
    unpack(in, sums.responsibility);
    unpack(in, sums.offset);
    unpack(in, sums.squared);
}

void pack(Packer& out, const MixtureFit& fit) {
    pack(out, fit.model);
    out.put(fit.mean_log_likelihood);
    pack(out, fit.history);
    out.put<uint8_t>(fit.converged);
}

void unpack(Unpacker& in, MixtureFit& fit) {
    unpack(in, fit.model);
    fit.mean_log_likelihood = in.get<double>();
    unpack(in, fit.history);
    fit.converged = in.get<uint8_t>();
}

void pack(Packer& out, const MixtureProgress& progress) {
    out.put<int32_t>(progress.restart).put<int32_t>(progress.iteration);
    out.put(progress.mean_log_likelihood);
    pack(out, progress.history);
    out.put<uint8_t>(progress.converged);
    pack(out, progress.model);
    pack(out, progress.best);
}

void unpack(Unpacker& in, MixtureProgress& progress) {
    progress.restart = in.get<int32_t>();
    progress.iteration = in.get<int32_t>();
    progress.mean_log_likelihood = in.get<double>();
    unpack(in, progress.history);
    progress.converged = in.get<uint8_t>();
    unpack(in, progress.model);
    unpack(in, progress.best);
}

}  // namespace kinetome
