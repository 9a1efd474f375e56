#include "session/comparison.h"

#include <algorithm>

#include "base/check.h"
#include "base/round_numbers.h"
#include "render/feature_pictures.h"
#include "tf/empty_features.h"

namespace pellucid {

ComparedState comparedState(const Session& session, std::string name) {
    PELLUCID_CHECK(session.tf() != nullptr);
    return {std::move(name), *session.tf(), session.camera, session.frame, session.display, session.clipping};
}

ComparedState comparedState(const Scene& scene, std::string name) {
    ComparedState state = comparedState(scene.session, std::move(name));
    state.camera = scene.camera;
    return state;
}

Session comparedSession(const Session& present) {
    const ComparisonView& view = *present.comparison;
    const ComparedState& b = view.b.value();
    Session session = present;
    if (!view.sameView) session.camera = b.camera;
    if (!view.sameFrame) session.frame = b.frame;
    if (!view.sameLook) {
        session.display = b.display;
        session.clipping = b.clipping;
    }
    // One transfer function for all frames, whose features find their identities among the present ones.
    session.comparison = {};
    session.adapt = {};
    session.variables.edit([&](std::vector<Variable>& all) {
        TfTrack track;
        if (const auto tf = present.tf()) track.keys.emplace(0, *tf);
        all.front().track = std::move(track);
    });
    session.setTf(*b.tf);
    return session;
}

SideInput sideInput(const Scene& scene, PictureInput picture, bool withSaliency) {
    return {measureInput(scene), std::move(picture), emptyFeatures(scene.tf, *scene.histogram), withSaliency};
}

ComparedSide comparedSide(const SideInput& input, const Measures& measures, ImageRenderer& renderer,
                          const JobControl& job) {
    ComparedSide side;
    const auto& features = input.measure.tf.features;
    for (std::size_t f = 0; f < features.size(); ++f)
        side.features.push_back({features[f].name,
                                 features[f].color,
                                 input.empty.at(f),
                                 measures.features.at(f).vws,
                                 measures.features.at(f).visibility,
                                 measures.opacities.at(f),
                                 {}});
    const PictureInput& p = input.picture;
    if (!input.withSaliency) {
        side.image = renderer.render(p.camera, p.tf, p.settings, job);
        return side;
    }
    FeaturePictures pictures = featurePictures(renderer, p.camera, p.tf, p.settings, job.part(0, 2));
    const FeatureSaliency saliency = featureSaliency(pictures, job.part(1, 2));
    for (std::size_t f = 0; f < features.size(); ++f) side.features[f].fs = saliency.shares.at(f);
    // Saliency is of the first volume, the picture of both.
    side.image = p.settings.overlay ? renderer.render(p.camera, p.tf, p.settings, job) : std::move(pictures.whole);
    return side;
}

std::vector<FeaturePair> pairsOf(const std::vector<FeatureFigures>& a, const std::vector<FeatureFigures>& b) {
    std::vector<FeaturePair> pairs;
    for (const FeatureFigures& f : a) pairs.push_back({f.name, f, {}});
    for (const FeatureFigures& f : b) {
        // Of features of one name, the first belongs to the first.
        const auto pair = std::ranges::find_if(pairs, [&](const FeaturePair& p) { return p.name == f.name && !p.b; });
        if (pair != pairs.end())
            pair->b = f;
        else
            pairs.push_back({f.name, {}, f});
    }
    return pairs;
}

std::span<const ComparedFigure> comparedFigures() {
    using F = FeatureFigures;
    using Value = std::optional<double>;
    static constexpr ComparedFigure kFigures[] = {
        {"vws", "VWS", [](const F& f) -> Value { return f.vws; }},
        {"visibility", "visibility", [](const F& f) -> Value { return f.visibility; }},
        {"fs", "2DFS", [](const F& f) { return f.fs; }},
        {"opacity", "opacity", [](const F& f) -> Value { return f.opacity; }},
    };
    return kFigures;
}

Comparison comparisonOf(std::string nameA, ComparedSide a, std::string nameB, ComparedSide b) {
    PictureDifference difference = differenceOf(a.image, b.image, nameA + " and " + nameB);
    return {std::move(nameA),   std::move(nameB),      std::move(a.image),
            std::move(b.image), std::move(difference), pairsOf(a.features, b.features)};
}

std::string wordsOf(const PictureDifference& d) {
    return "SSIM " + fixedText(d.ssim, 4) + ", mean delta E " + fixedText(d.mean, 3) + ", largest " +
           fixedText(d.largest, 2) + ", " + fixedText(100 * d.noticed, 1) + " % of the pixels above " +
           fixedText(kNoticedDeltaE, 1);
}

} // namespace pellucid
