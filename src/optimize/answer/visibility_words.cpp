#include "optimize/answer/visibility_words.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace pellucid {

namespace {

constexpr double kSameShares = 0.005; ///< F below which shares read alike in per cent

/// 'a', 'b' and 'c'
std::string namesOf(const TransferFunction& tf, const std::vector<std::size_t>& features) {
    std::string text;
    for (std::size_t i = 0; i < features.size(); ++i)
        text += (i == 0 ? "" : i + 1 == features.size() ? " and " : ", ") + ("'" + tf.features[features[i]].name + "'");
    return text;
}

/// 33 %, 33 % and 33 %
std::string sharesText(const std::vector<double>& shares) {
    std::string text;
    for (std::size_t f = 0; f < shares.size(); ++f)
        text += (f == 0 ? "" : f + 1 == shares.size() ? " and " : ", ") + percentText(shares[f]);
    return text;
}

/// "the picture is 0.4 % opaque, and 'f3' adds 0.1 % to the pixels that it covers"
std::string thinness(const TransferFunction& tf, const std::vector<double>& targets, const Coverage& look) {
    std::vector<std::size_t> unseen;
    double most = 0;
    for (std::size_t f = 0; f < targets.size(); ++f)
        if (targets[f] > 0 && look.covers[f] < kFaintCover) {
            unseen.push_back(f);
            most = std::max(most, look.covers[f]);
        }
    std::string text = "the picture is " + percentText(look.coverage) + " opaque";
    if (!unseen.empty())
        text += ", and " + namesOf(tf, unseen) + (unseen.size() == 1 ? " adds " : " add at most ") + percentText(most) +
                (unseen.size() == 1 ? " to the pixels that it covers" : " to the pixels that they cover");
    return text;
}

} // namespace

std::string percentText(double share) {
    if (share > 0 && share < 0.0005) return "< 0.1 %";
    char text[32];
    std::snprintf(text, sizeof text, share < 0.0995 && share > 0 ? "%.1f %%" : "%.0f %%", 100 * share);
    return text;
}

std::string keptText(const OptimizeResult& result) {
    if (!result.seen || !result.seen->exact) return {};
    const SeenShares& exact = *result.seen->exact;
    const bool isExact = exact.objective < kSameShares;
    const bool isAll = !result.seen->faint && result.seen->unseen.empty();
    return "Asked for " + sharesText(result.targets) + "; kept " + sharesText(result.history[result.best].vws) +
           (isAll ? ", so that all of it can be seen: " : ", so that more of it can be seen: ") +
           (isExact ? "with the shares asked for " : "nearer to these shares ") +
           thinness(result.tf, result.targets, exact.look) + ".";
}

std::string faintText(const OptimizeResult& result) {
    if (!result.seen || (!result.seen->faint && result.seen->unseen.empty())) return {};
    std::string text = thinness(result.tf, result.targets, result.seen->coverage);
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (!result.seen->visible) return text + ".";
    const SeenShares& visible = *result.seen->visible;
    return text + ". Shares of " + sharesText(visible.vws) + " would show it: the picture would be " +
           percentText(visible.look.coverage) + " opaque.";
}

} // namespace pellucid
