// 2D saliency by the book: one loop for each sum of docs/method.md, "2D feature saliency", in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "saliency/image_saliency.h"
#include "tf/lch.h"

namespace pellucid {

namespace {

using Level = BasicPlane<double>;

Level zeros(int width, int height) { return {width, height}; }

/// The index that i has after mirroring at the first and the last of n, which are not repeated.
int mirrored(int i, int n) {
    while (i < 0 || i >= n) {
        if (n == 1) return 0;
        i = i < 0 ? -i : 2 * (n - 1) - i;
    }
    return i;
}

/// A component as it is seen over black.
double seen(const Image& image, int x, int y, int component) {
    const float* p = image.pixel(x, y);
    const double v = static_cast<double>(p[component]) * static_cast<double>(p[3]);
    return v > 0 ? std::min(v, 1.0) : 0;
}

/// The convolution with a square kernel of odd width, [row][column].
Level convolved(const Level& in, const std::vector<std::vector<double>>& kernel) {
    const int reach = static_cast<int>(kernel.size()) / 2;
    Level out = zeros(in.width, in.height);
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            for (int dy = -reach; dy <= reach; ++dy)
                for (int dx = -reach; dx <= reach; ++dx)
                    out.row(y)[x] +=
                        kernel[static_cast<std::size_t>(dy + reach)][static_cast<std::size_t>(dx + reach)] *
                        in.row(mirrored(y - dy, in.height))[mirrored(x - dx, in.width)];
    return out;
}

Level halved(const Level& in) {
    const std::array<double, 5> binomial{1, 4, 6, 4, 1};
    std::vector<std::vector<double>> kernel(5, std::vector<double>(5));
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j) kernel[i][j] = binomial[i] * binomial[j] / 256;
    const Level blurred = convolved(in, kernel);
    Level out = zeros((in.width + 1) / 2, (in.height + 1) / 2);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) out.row(y)[x] = blurred.row(2 * y)[2 * x];
    return out;
}

Level enlarged(const Level& in, int width, int height) {
    Level out = zeros(width, height);
    const auto place = [](int i, int n, int from) {
        return std::clamp((i + 0.5) * from / n - 0.5, 0.0, static_cast<double>(from - 1));
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double px = place(x, width, in.width), py = place(y, height, in.height);
            const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
            const int x1 = std::min(x0 + 1, in.width - 1), y1 = std::min(y0 + 1, in.height - 1);
            const double fx = px - x0, fy = py - y0;
            out.row(y)[x] = (1 - fy) * ((1 - fx) * in.row(y0)[x0] + fx * in.row(y0)[x1]) +
                            fy * ((1 - fx) * in.row(y1)[x0] + fx * in.row(y1)[x1]);
        }
    return out;
}

/// N of eq. "conspicuity": maps with one peak are kept, those with many are pressed down.
Level normalized(Level m) {
    const double top = *std::max_element(m.values.begin(), m.values.end());
    if (!(top > 1e-9)) return zeros(m.width, m.height); // of rounding
    for (double& v : m.values) v /= top;
    std::vector<double> peaks;
    for (int y = 0; y < m.height; ++y)
        for (int x = 0; x < m.width; ++x) {
            const double v = m.row(y)[x];
            bool least = true, some = false;
            for (int ny = std::max(0, y - 1); ny <= std::min(m.height - 1, y + 1); ++ny)
                for (int nx = std::max(0, x - 1); nx <= std::min(m.width - 1, x + 1); ++nx) {
                    if (v < m.row(ny)[nx]) least = false;
                    if (v > m.row(ny)[nx]) some = true;
                }
            if (v >= 0.1 && least && some) peaks.push_back(v);
        }
    double mean = 0;
    if (peaks.size() > 1) {
        peaks.erase(std::max_element(peaks.begin(), peaks.end()));
        for (const double p : peaks) mean += p / static_cast<double>(peaks.size());
    }
    for (double& v : m.values) v *= (1 - mean) * (1 - mean);
    return m;
}

void add(Level& sum, const Level& part) {
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += part.values[i];
}

using Pyramid = std::vector<Level>;

Pyramid pyramidOf(const Level& base) {
    Pyramid levels{base};
    while (levels.size() < 9) levels.push_back(halved(levels.back()));
    return levels;
}

/// Of N of all |centre − surround|, brought to level 4, the sum.
Level conspicuity(const Pyramid& m) {
    Level sum = zeros(m[4].width, m[4].height);
    for (std::size_t c = 2; c <= 4; ++c)
        for (std::size_t s = c + 3; s <= c + 4; ++s) {
            Level difference = enlarged(m[s], m[c].width, m[c].height);
            for (std::size_t i = 0; i < difference.values.size(); ++i)
                difference.values[i] = std::abs(m[c].values[i] - difference.values[i]);
            Level map = normalized(difference);
            for (std::size_t level = c; level < 4; ++level) map = halved(map);
            add(sum, map);
        }
    return sum;
}

Level orientation(const Level& in, double degrees) {
    constexpr double kSigma = 7.0 / 3.0, kPi = std::numbers::pi;
    std::array<Level, 2> answers; // even and odd
    for (std::size_t part = 0; part < 2; ++part) {
        std::vector<std::vector<double>> kernel(9, std::vector<double>(9));
        double mean = 0, size = 0;
        for (int y = -4; y <= 4; ++y)
            for (int x = -4; x <= 4; ++x) {
                const double u = x * std::cos(degrees * kPi / 180) + y * std::sin(degrees * kPi / 180);
                const double wave = part == 0 ? std::cos(2 * kPi * u / 7) : std::sin(2 * kPi * u / 7);
                double& k = kernel[static_cast<std::size_t>(y + 4)][static_cast<std::size_t>(x + 4)];
                k = std::exp(-(x * x + y * y) / (2 * kSigma * kSigma)) * wave;
                mean += k / 81;
            }
        for (auto& row : kernel)
            for (double& k : row) size += std::abs(k -= mean);
        for (auto& row : kernel)
            for (double& k : row) k /= size;
        answers[part] = convolved(in, kernel);
    }
    Level out = zeros(in.width, in.height);
    for (std::size_t i = 0; i < out.values.size(); ++i)
        out.values[i] = std::hypot(answers[0].values[i], answers[1].values[i]);
    return out;
}

Plane asFloats(const Level& in) {
    Plane out(in.width, in.height);
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = static_cast<float>(in.values[i]);
    return out;
}

Level mapOf(const Image& picture) {
    const int width = picture.width, height = picture.height;
    Level intensity = zeros(width, height), redGreen = intensity, blueYellow = intensity;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            intensity.row(y)[x] = (seen(picture, x, y, 0) + seen(picture, x, y, 1) + seen(picture, x, y, 2)) / 3;
    const double brightest = *std::max_element(intensity.values.begin(), intensity.values.end());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double i = intensity.row(y)[x];
            if (!(i > brightest / 10)) continue;
            const double r = seen(picture, x, y, 0) / i, g = seen(picture, x, y, 1) / i, b = seen(picture, x, y, 2) / i;
            const double red = std::max(0.0, r - (g + b) / 2), green = std::max(0.0, g - (r + b) / 2);
            const double blue = std::max(0.0, b - (r + g) / 2);
            const double yellow = std::max(0.0, (r + g) / 2 - std::abs(r - g) / 2 - b);
            redGreen.row(y)[x] = red - green;
            blueYellow.row(y)[x] = blue - yellow;
        }
    const Pyramid levels = pyramidOf(intensity);
    Level colors = conspicuity(pyramidOf(redGreen));
    add(colors, conspicuity(pyramidOf(blueYellow)));
    Level orientations = zeros(levels[4].width, levels[4].height);
    for (const double degrees : {0.0, 45.0, 90.0, 135.0}) {
        Pyramid turned;
        for (const Level& level : levels) turned.push_back(orientation(level, degrees));
        add(orientations, normalized(conspicuity(turned)));
    }
    Level sum = normalized(conspicuity(levels));
    add(sum, normalized(colors));
    add(sum, normalized(orientations));
    for (double& v : sum.values) v /= 3;
    return enlarged(sum, width, height);
}

Level blurred(const Level& in) {
    const double sigma = in.width / 16.0;
    const int reach = static_cast<int>(4 * sigma);
    const auto weight = [&](int d) { return std::exp(-d * d / (2 * sigma * sigma)); };
    Level across = zeros(in.width, in.height), out = across;
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            for (int i = std::max(0, x - reach); i <= std::min(in.width - 1, x + reach); ++i)
                across.row(y)[x] += weight(i - x) * in.row(y)[i];
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            for (int i = std::max(0, y - reach); i <= std::min(in.height - 1, y + reach); ++i)
                out.row(y)[x] += weight(i - y) * across.row(i)[x];
    return out;
}

Lab labAt(const Image& image, int x, int y) {
    const float* p = image.pixel(x, y);
    return labFromSrgb({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
}

/// w of one pixel.
std::vector<double> weightsAt(const FeaturePictures& pictures, int x, int y) {
    const std::size_t features = pictures.alone.size();
    std::vector<double> distance(features), weight(features, 0.0);
    std::vector<std::size_t> drawn, equal;
    for (std::size_t f = 0; f < features; ++f) {
        if (!(pictures.alone[f].pixel(x, y)[3] > 0)) continue;
        drawn.push_back(f);
        distance[f] = deltaE(labAt(pictures.whole, x, y), labAt(pictures.alone[f], x, y));
        if (distance[f] == 0) equal.push_back(f);
    }
    double sum = 0;
    for (const std::size_t f : equal.empty() ? drawn : equal) sum += weight[f] = equal.empty() ? 1 / distance[f] : 1;
    for (double& w : weight)
        if (sum > 0) w /= sum;
    return weight;
}

} // namespace

Plane saliencyMapReference(const Image& picture) {
    if (picture.rgba.empty()) return {picture.width, picture.height};
    return asFloats(mapOf(picture));
}

FeatureSaliency featureSaliencyReference(const FeaturePictures& pictures) {
    const int width = pictures.whole.width, height = pictures.whole.height;
    const std::size_t features = pictures.alone.size();
    FeatureSaliency answer;
    answer.shares.assign(features, 0.0);
    if (pictures.whole.rgba.empty()) return answer;
    const Level map = mapOf(pictures.whole);
    Level rest = map;
    std::vector<Level> shared(features, zeros(width, height)), influence, spread = shared;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::vector<double> weight = weightsAt(pictures, x, y);
            for (std::size_t f = 0; f < features; ++f) {
                shared[f].row(y)[x] = weight[f] * map.row(y)[x];
                rest.row(y)[x] -= shared[f].row(y)[x];
            }
        }
    for (const Level& level : shared) influence.push_back(blurred(level));
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        double all = 0;
        for (const Level& level : influence) all += level.values[i];
        for (std::size_t f = 0; f < features && all > 0; ++f)
            spread[f].values[i] = influence[f].values[i] / all * rest.values[i];
    }
    double all = 0;
    for (std::size_t f = 0; f < features; ++f) {
        for (std::size_t i = 0; i < map.values.size(); ++i)
            answer.shares[f] += shared[f].values[i] + spread[f].values[i];
        all += answer.shares[f];
    }
    for (double& share : answer.shares) share = all > 0 ? share / all : 0;
    answer.map = asFloats(map);
    answer.rest = asFloats(rest);
    for (std::size_t f = 0; f < features; ++f) {
        answer.shared.push_back(asFloats(shared[f]));
        answer.influence.push_back(asFloats(influence[f]));
        answer.spread.push_back(asFloats(spread[f]));
    }
    return answer;
}

} // namespace pellucid
