#include "kinetome/stages/pose_cluster_file.h"

namespace kinetome {
namespace {

std::span<const double> values_of(const VectorD& vector) {
    return {vector.data(), static_cast<size_t>(vector.size())};
}

VectorD read_vector(const ArtifactReader& file, const std::string& path) {
    const auto values = file.read<double>(path);
    return Eigen::Map<const VectorD>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

void write_pose_clusters(ArtifactWriter& file, const std::string& partition, const Pca& pca,
                         const PoseClusters& clusters) {
    const auto spec = [&](const char* name, std::vector<int64_t> shape, const char* units,
                          const char* description, const char* source) {
        return DatasetSpec{partition + "/" + name,
                           ElementType::float64,
                           std::move(shape),
                           units,
                           description,
                           source,
                           "",
                           {}};
    };
    const auto write = [&](const DatasetSpec& dataset, const VectorD& values) {
        file.write<double>(dataset, values_of(values));
    };
    const auto write_rows = [&](const DatasetSpec& dataset, const MatrixD& rows) {
        file.create(dataset);
        file.append(dataset.path, rows);
    };
    const Mixture& mixture = clusters.fit.model;
    write(spec("pca/mean", {}, "column's unit", "mean of each pose vector column", "S1 §3.2"),
          pca.mean);
    write(spec("pca/scale", {}, "column's unit", "scale of each pose vector column, floored", ""),
          pca.scale);
    write_rows(
        spec("pca/components", {pca.dimension()}, "1",
             "principal components, one a column: y = componentsᵀ ((x - mean) / scale)", "S1 §3.2"),
        pca.components);
    write(
        spec("pca/variances", {}, "1", "all eigenvalues of the standardised covariance", "S1 §3.2"),
        pca.variances);
    write_rows(spec("means", {mixture.dimension()}, "1", "mean of each cluster, a row a letter",
                    "S1 §3.2"),
               mixture.means);
    write(spec("variances", {}, "1", "variance σ² of each cluster, the same in every direction",
               "S1 §3.2"),
          mixture.variances);
    write(spec("weights", {}, "1", "mixing weight of each cluster", "S1 §3.2"), mixture.weights);
    file.write<double>(spec("log_likelihood", {}, "nats a frame",
                            "mean log-likelihood before each iteration of EM", ""),
                       clusters.fit.history);
    const double last = clusters.fit.mean_log_likelihood;
    file.write<double>(
        spec("final_log_likelihood", {}, "nats a frame", "mean log-likelihood of the model", ""),
        std::span(&last, 1));
    std::vector<int64_t> counts;
    std::vector<double> information;
    for (const TriedClusterCount& tried : clusters.tried) {
        counts.push_back(tried.clusters);
        information.push_back(tried.bayesian_information);
    }
    DatasetSpec tried = spec("tried/clusters", {}, "1", "numbers of clusters that were fitted", "");
    tried.type = ElementType::int64;
    file.write<int64_t>(tried, counts);
    file.write<double>(spec("tried/bayesian_information", {}, "nats",
                            "Bayesian information criterion of each, lower is better", ""),
                       information);
}

StoredPoseClusters read_pose_clusters(const ArtifactReader& file, const std::string& partition) {
    StoredPoseClusters stored;
    stored.pca.mean = read_vector(file, partition + "/pca/mean");
    stored.pca.scale = read_vector(file, partition + "/pca/scale");
    stored.pca.components = file.read_matrix_double(partition + "/pca/components");
    stored.pca.variances = read_vector(file, partition + "/pca/variances");
    stored.mixture.means = file.read_matrix_double(partition + "/means");
    stored.mixture.variances = read_vector(file, partition + "/variances");
    stored.mixture.weights = read_vector(file, partition + "/weights");
    return stored;
}

}  // namespace kinetome
