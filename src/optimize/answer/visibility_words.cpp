#include "optimize/answer/visibility_words.h"

#include <algorithm>
#include <cctype>
#include <span>

#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

namespace {

constexpr double kSameShares = 0.005; ///< F below which shares read alike in per cent

/// 33 %, 33 % and 33 %
std::string sharesText(const std::vector<double>& shares) {
    std::vector<std::string> words;
    for (const double share : shares) words.push_back(percentText(share));
    return listed(words);
}

/// "the picture is 0.4 % opaque, and 'f3' adds 0.1 % to the pixels that it covers"
std::string thinness(const TransferFunction& tf, const std::vector<double>& targets, const Coverage& look) {
    std::vector<std::string> unseen;
    double most = 0;
    for (std::size_t f = 0; f < targets.size(); ++f)
        if (targets[f] > 0 && look.covers[f] < kFaintCover) {
            unseen.push_back("'" + tf.features[f].name + "'");
            most = std::max(most, look.covers[f]);
        }
    std::string text = "the picture is " + percentText(look.coverage) + " opaque";
    if (!unseen.empty())
        text += ", and " + listed(unseen) + (unseen.size() == 1 ? " adds " : " add at most ") + percentText(most) +
                (unseen.size() == 1 ? " to the pixels that it covers" : " to the pixels that they cover");
    return text;
}

} // namespace

std::string listed(const std::vector<std::string>& words) {
    if (words.size() < 2) return joined(words);
    return joined(std::span(words).first(words.size() - 1)) + " and " + words.back();
}

std::string percentText(double share) {
    if (share > 0 && share < 0.0005) return "< 0.1 %";
    return fixedText(100 * share, share < 0.0995 && share > 0 ? 1 : 0) + " %";
}

std::string offTargetText(double objective) {
    return objective > 0 && objective < 0.0005 ? "off target by less than 0.1 %"
                                               : "off target by " + percentText(objective);
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
