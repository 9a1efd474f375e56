#include "render/picture_shares.h"

#include <algorithm>
#include <array>

#include "render/overlay.h"

namespace pellucid {

namespace {

constexpr int kChannels = 3; // of a picture: as many things are told apart in one

/// The same opacities, with steps of the colour where features begin and end: 1 in channel c for feature first + c.
TransferFunction withMarkedFeatures(const TransferFunction& tf, int first) {
    const auto markAt = [&](double from, double to) { // of the piece between two points
        const double middle = 0.5 * (from + to);
        const auto isIn = [&](int channel) {
            const auto f = static_cast<std::size_t>(first + channel);
            return f < tf.features.size() && tf.features[f].a <= middle && middle <= tf.features[f].b ? 1.0 : 0.0;
        };
        return Rgb{isIn(0), isIn(1), isIn(2)};
    };
    std::vector<ControlPoint> points = tf.pointsWithEnds();
    const TfSampler opacities(tf);
    for (const Feature& feature : tf.features)
        for (const double border : {feature.a, feature.b}) {
            const bool isThere = std::ranges::any_of(points, [&](const ControlPoint& p) { return p.x == border; });
            if (isThere) continue;
            const auto after = std::ranges::upper_bound(points, border, {}, &ControlPoint::x);
            points.insert(after, {border, opacities.opacity(border), {}, false, {}});
        }
    // Every piece gets two ends of its own.
    TransferFunction marked = tf;
    marked.points.clear();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (points[i].x == points[i + 1].x) continue;
        const Rgb mark = markAt(points[i].x, points[i + 1].x);
        for (const ControlPoint* end : {&points[i], &points[i + 1]})
            marked.points.push_back({end->x, end->opacity, mark, false, {}});
    }
    return marked;
}

std::shared_ptr<const Overlay> inOneColor(const std::shared_ptr<const Overlay>& overlay, const Rgb& color) {
    if (!overlay) return nullptr;
    auto colored = std::make_shared<Overlay>(*overlay);
    for (ControlPoint& point : colored->tf.points) point.color = color;
    return colored;
}

/// Means over all pixels of the premultiplied channels, and of alpha.
std::array<double, 4> meansOf(const Image& image) {
    std::array<double, 4> sums{};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const double alpha = image.rgba[i + 3];
        for (std::size_t c = 0; c < 3; ++c) sums[c] += static_cast<double>(image.rgba[i + c]) * alpha;
        sums[3] += alpha;
    }
    for (double& sum : sums) sum /= static_cast<double>(image.width) * image.height;
    return sums;
}

} // namespace

PictureShares pictureShares(ImageRenderer& renderer, const Camera& camera, const TransferFunction& tf,
                            const RenderSettings& settings, const JobControl& job) {
    RenderSettings plain = settings;
    plain.mode = RenderMode::Composite;
    plain.background.reset();
    plain.backgroundTop.reset();
    plain.colors.reset();
    plain.ground.reset();
    plain.light = {};
    plain.light.gradientOpacity = settings.light.gradientOpacity;

    const int count = static_cast<int>(tf.features.size()), pictures = (count + kChannels - 1) / kChannels;
    PictureShares shares;
    shares.features.resize(tf.features.size());
    double known = 0;
    for (int p = 0; p < pictures; ++p) {
        plain.overlay = inOneColor(settings.overlay, {0, 0, 0});
        const JobControl part = job.part(static_cast<std::size_t>(p), static_cast<std::size_t>(pictures) + 1);
        const auto means = meansOf(renderer.render(camera, withMarkedFeatures(tf, p * kChannels), plain, part));
        for (int f = p * kChannels; f < std::min(count, (p + 1) * kChannels); ++f)
            known += shares.features[static_cast<std::size_t>(f)] = means[static_cast<std::size_t>(f % kChannels)];
    }
    TransferFunction black = tf;
    for (ControlPoint& point : black.points) point.color = {0, 0, 0};
    plain.overlay = inOneColor(settings.overlay, {1, 1, 1});
    const auto means = meansOf(renderer.render(
        camera, black, plain, job.part(static_cast<std::size_t>(pictures), static_cast<std::size_t>(pictures) + 1)));
    shares.overlay = means[0];
    shares.alpha = means[3];
    shares.rest = std::max(0.0, shares.alpha - known - shares.overlay);
    return shares;
}

} // namespace pellucid
