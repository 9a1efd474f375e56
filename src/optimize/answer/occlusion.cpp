#include "optimize/answer/occlusion.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace pellucid {

namespace {
constexpr double kWorthTelling = 0.1;
} // namespace

OcclusionMatrix occlusionOf(const std::vector<FeatureSums>& sums) {
    const std::size_t n = sums.size() - 1;
    OcclusionMatrix matrix(n, std::vector<double>(n, 0.0));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            const double without = sums[j + 1].visibility[i];
            if (i != j && without > 0) matrix[i][j] = std::clamp(1 - sums[0].visibility[i] / without, 0.0, 1.0);
        }
    return matrix;
}

OcclusionMatrix occlusion(VisibilityEngine& engine, const View& view, const TransferFunction& tf,
                          const JobControl& job) {
    const std::size_t n = tf.features.size();
    if (n == 0) return {};
    std::vector<TransferFunction> tfs{tf};
    for (std::size_t j = 0; j < n; ++j) {
        std::vector<double> x = featureOpacities(tf);
        x[j] = 0;
        tfs.push_back(withFeatureOpacities(tf, x));
    }
    return occlusionOf(engine.sums(view, tfs, nullptr, job));
}

std::vector<std::string> occlusionWords(const OcclusionMatrix& matrix, const std::vector<Feature>& features,
                                        std::size_t most) {
    struct Hiding {
        double part;
        std::size_t hidden, hider;
    };
    std::vector<Hiding> all;
    for (std::size_t i = 0; i < matrix.size(); ++i)
        for (std::size_t j = 0; j < matrix.size(); ++j)
            if (matrix[i][j] >= kWorthTelling) all.push_back({matrix[i][j], i, j});
    std::ranges::stable_sort(all, std::greater{}, &Hiding::part);
    if (all.size() > most) all.resize(most);
    std::vector<std::string> words;
    for (const Hiding& h : all)
        words.push_back(features[h.hider].name + " hides " + std::to_string(std::lround(100 * h.part)) + " % of " +
                        features[h.hidden].name);
    return words;
}

} // namespace pellucid
