#include "optimize/visibility_words.h"

#include <cmath>
#include <cstdio>

namespace pellucid {

namespace {

/// 'a', 'b' and 'c'
std::string namesOf(const TransferFunction& tf, const std::vector<std::size_t>& features) {
    std::string text;
    for (std::size_t i = 0; i < features.size(); ++i)
        text += (i == 0 ? "" : i + 1 == features.size() ? " and " : ", ") + ("'" + tf.features[features[i]].name + "'");
    return text;
}

} // namespace

std::string percentText(double share) {
    if (share > 0 && share < 0.0005) return "< 0.1 %";
    char text[32];
    std::snprintf(text, sizeof text, share < 0.0995 && share > 0 ? "%.1f %%" : "%.0f %%", 100 * share);
    return text;
}

std::string faintText(const TransferFunction& tf, const Faintness& faint, double strongest) {
    std::string text;
    if (faint.picture)
        text = "the picture has " + percentText(strongest) + " of alpha" + (faint.searched ? " at most" : "");
    if (!faint.features.empty())
        text += (text.empty() ? "" : ", and ") + namesOf(tf, faint.features) +
                (faint.features.size() == 1 ? " has" : " have") + " less than " + percentText(kFaintCover) +
                (faint.features.size() == 1 ? " where it is seen" : " where they are seen");
    if (!faint.searched) return text + "."; // what could be had instead nobody knows
    if (!faint.limiting.empty())
        text += ", because " + namesOf(tf, faint.limiting) + " cannot become more opaque and more of " +
                "anything else would take from " + (faint.limiting.size() == 1 ? "its share" : "their shares");
    text += ". ";
    if (!faint.remedy) return text + "No shares close to these were found that would be visible.";
    const Faintness::Remedy& remedy = *faint.remedy;
    text += "Shares of ";
    for (std::size_t f = 0; f < remedy.shares.size(); ++f) text += (f == 0 ? "" : ", ") + percentText(remedy.shares[f]);
    text += " would show it: " + percentText(remedy.coverage.coverage) + " of alpha";
    for (const std::size_t f : faint.features)
        text += ", '" + tf.features[f].name + "' " + percentText(remedy.coverage.covers[f]);
    return text + ".";
}

std::string faintText(const OptimizeResult& result) {
    if (!result.seen || !result.seen->faint) return {};
    return faintText(result.tf, *result.seen->faint, result.seen->strongest);
}

} // namespace pellucid
