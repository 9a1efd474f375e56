#include "session/caption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "base/text.h"
#include "optimize/answer/visibility_words.h"
#include "render/standard_view.h"
#include "volume/file_names.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostNamed = 4;

/// Toward an observer at these angles, as cameraFromView() has them.
Vec3 towardEyeAt(const ViewAngles& angles) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double azimuth = angles.azimuth * kDegree, elevation = angles.elevation * kDegree;
    return {std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
}

const char* sideWords(StandardView side, WorldAxes axes) {
    const bool isPatient = axes == WorldAxes::Patient;
    switch (side) {
    case StandardView::Front:
        return "the front";
    case StandardView::Back:
        return "behind";
    case StandardView::Left:
        return isPatient ? "the patient's left" : "the left";
    case StandardView::Right:
        return isPatient ? "the patient's right" : "the right";
    case StandardView::Top:
        return "above";
    case StandardView::Bottom:
        break;
    }
    return "below";
}

std::string capitalized(std::string text) {
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
        text.front() = static_cast<char>(text.front() - 'a' + 'A');
    return text;
}

const char* modeWords(RenderMode mode) {
    switch (mode) {
    case RenderMode::Mip:
        return "the largest value along each ray";
    case RenderMode::MinIp:
        return "the smallest value along each ray";
    case RenderMode::Average:
        return "the mean value along each ray";
    case RenderMode::Surface:
        return "surfaces of features";
    case RenderMode::Composite:
        break;
    }
    return "";
}

/// "From the right, lit, cut open: tooth, t = 3 s"
std::string viewSentence(const CaptionFacts& facts) {
    std::string text = capitalized(facts.from);
    if (facts.mode != RenderMode::Composite) text += std::string(", ") + modeWords(facts.mode);
    if (facts.lit) text += ", lit";
    if (facts.cut) text += ", cut open";
    text += ": " + facts.title;
    if (!facts.alone.empty()) text += ", " + facts.alone + " alone";
    return facts.frame.empty() ? text : text + ", " + facts.frame;
}

/// Indices of features that are drawn, those with most saliency first.
std::vector<std::size_t> bySaliency(const std::vector<CaptionFeature>& features) {
    std::vector<std::size_t> order;
    for (std::size_t f = 0; f < features.size(); ++f)
        if (features[f].state == CaptionFeature::State::Drawn) order.push_back(f);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return features[a].vws > features[b].vws; });
    return order;
}

std::string sharesSentence(const std::vector<CaptionFeature>& features) {
    const std::vector<std::size_t> order = bySaliency(features);
    const bool areFew = order.size() <= kMostNamed + 1; // "the other one" would be no shorter than its name
    const std::size_t named = areFew ? order.size() : kMostNamed;
    std::string text;
    for (std::size_t n = 0; n < named; ++n) {
        const CaptionFeature& f = features[order[n]];
        text += n == 0 ? f.name + " has " + percentText(f.vws) + " of the saliency and " + percentText(f.visibility) +
                             " of what is visible"
                       : "; " + f.name + " " + percentText(f.vws) + " and " + percentText(f.visibility);
    }
    if (named < order.size()) {
        double vws = 0, visibility = 0;
        for (std::size_t n = named; n < order.size(); ++n) {
            vws += features[order[n]].vws;
            visibility += features[order[n]].visibility;
        }
        text += "; " + std::to_string(order.size() - named) + " others together " + percentText(vws) + " and " +
                percentText(visibility);
    }
    return text;
}

std::vector<std::string> namesOf(const std::vector<CaptionFeature>& features, CaptionFeature::State state) {
    std::vector<std::string> names;
    for (const CaptionFeature& f : features)
        if (f.state == state) names.push_back(f.name);
    return names;
}

} // namespace

std::string directionWords(const Vec3& towardEye, WorldAxes axes) {
    const double least = std::cos(67.5 * std::numbers::pi / 180);
    const Vec3 direction = glm::normalize(towardEye);
    std::vector<std::pair<double, StandardView>> near;
    for (const StandardView side : kStandardViews)
        if (const double cosine = glm::dot(direction, towardEyeAt(anglesOf(side, axes))); cosine >= least)
            near.emplace_back(cosine, side);
    std::ranges::stable_sort(near, [](const auto& a, const auto& b) { return a.first > b.first + 1e-9; });
    std::vector<std::string> words;
    for (const auto& [cosine, side] : near) words.emplace_back(sideWords(side, axes));
    return "from " + listed(words);
}

CaptionFacts captionFacts(const Scene& scene, const Measures& measures, const OcclusionMatrix& occlusion) {
    CaptionFacts facts;
    facts.title = printable(scene.volume->title);
    if (const std::string suffix = volumeSuffix(facts.title); suffix.size() < facts.title.size())
        facts.title.resize(facts.title.size() - suffix.size());
    if (scene.series && scene.series->varies())
        facts.frame = printable(scene.series->listing().label(scene.session.frame));
    facts.from = directionWords(-scene.camera.forward(), scene.volume->geometry().worldAxes);
    facts.lit = scene.session.display->light.on;
    facts.cut = !scene.session.clipping->isNone();
    facts.mode = scene.session.display->mode;
    std::vector<Feature> named = scene.tf.features;
    const int alone = scene.onlyFeature();
    if (alone >= 0) facts.alone = printable(named[static_cast<std::size_t>(alone)].name);
    for (std::size_t f = 0; f < measures.features.size(); ++f) {
        if (alone >= 0 && static_cast<std::size_t>(alone) != f) continue;
        named[f].name = printable(named[f].name);
        using State = CaptionFeature::State;
        facts.features.push_back({named[f].name, measures.features.at(f).vws, measures.features.at(f).visibility,
                                  named[f].hidden    ? State::Hidden
                                  : scene.isEmpty(f) ? State::Empty
                                                     : State::Drawn});
    }
    if (alone >= 0) return facts; // nothing hides it, and the coverage is that of all
    if (!occlusion.empty()) facts.hides = occlusionWords(occlusion, named, 2);
    if (measures.coverage) facts.coverage = measures.coverage->coverage;
    return facts;
}

std::string caption(const CaptionFacts& facts) {
    using State = CaptionFeature::State;
    std::string text = viewSentence(facts) + ".";
    if (facts.mode != RenderMode::Composite) return text;
    const auto isSeen = [](const CaptionFeature& f) { return f.visibility > 0; };
    const bool isAlone = !facts.alone.empty(); // then it is seen, even where the others hide all of it
    if (!isAlone && !facts.features.empty() && std::ranges::none_of(facts.features, isSeen))
        return text + " Nothing is visible.";
    if (const std::string shares = sharesSentence(facts.features); !shares.empty()) {
        text += " " + (isAlone ? "Where all features are drawn, " + shares : capitalized(shares)) + ".";
        if (facts.coverage)
            text += " Where there is something to see, the picture is " + percentText(*facts.coverage) + " opaque.";
    }
    if (!facts.hides.empty()) text += " " + capitalized(joined(facts.hides, "; ")) + ".";
    if (const auto hidden = namesOf(facts.features, State::Hidden); !hidden.empty())
        text += " Not drawn: " + listed(hidden) + ".";
    if (const auto empty = namesOf(facts.features, State::Empty); !empty.empty())
        text += " Not in these data: " + listed(empty) + ".";
    return text;
}

std::string altText(const CaptionFacts& facts) {
    std::string text = viewSentence(facts);
    const std::vector<std::size_t> order = bySaliency(facts.features);
    if (facts.mode != RenderMode::Composite || order.empty() || !facts.alone.empty()) return text + ".";
    std::vector<std::string> most;
    for (std::size_t n = 0; n < std::min<std::size_t>(order.size(), 2); ++n) {
        const CaptionFeature& f = facts.features[order[n]];
        most.push_back(f.name + " (" + percentText(f.vws) + (n == 0 ? " of the saliency)" : ")"));
    }
    return text + ", mostly " + listed(most) + ".";
}

} // namespace pellucid
