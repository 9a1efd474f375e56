#include "saliency/image_saliency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "tf/lch.h"

namespace pellucid {

namespace {

using Level = BasicPlane<double>;
using Pyramid = std::array<Level, 9>;

constexpr int kBand = 32;                            ///< rows that a thread makes at a time
constexpr std::size_t kCoarsest = 4;                 ///< the level of the map
constexpr std::size_t kOrientations = 4;             ///< 0, 45, 90, 135°
constexpr std::size_t kChannels = 3 + kOrientations; ///< intensity, red–green, blue–yellow, orientations
constexpr double kRounding = 1e-9;                   ///< a map that is nowhere larger is 0
constexpr std::array<double, 3> kBinomial{6, 4, 1};  ///< over 16, from the middle on
constexpr std::array<std::array<std::size_t, 2>, 6> kScales{{{2, 5}, {2, 6}, {3, 6}, {3, 7}, {4, 7}, {4, 8}}};

std::size_t size(int n) { return static_cast<std::size_t>(n); }

int mirrored(int i, int n) {
    if (n == 1) return 0;
    const int period = 2 * (n - 1);
    i = (i % period + period) % period;
    return std::min(i, period - i);
}

/// Pieces of at most kBand rows.
template <class Body>
void forBands(int height, const JobControl& job, const Body& body) {
    parallelFor(size((height + kBand - 1) / kBand), [&](std::size_t band) {
        job.throwIfStopped();
        const int y0 = static_cast<int>(band) * kBand;
        body(y0, std::min(height, y0 + kBand));
    });
}

/// Halves a picture of `height` rows whose row y `fill` writes.
template <class Fill>
Level halved(int width, int height, const JobControl& job, const Fill& fill) {
    Level out((width + 1) / 2, (height + 1) / 2);
    forBands(out.height, job, [&](int y0, int y1) {
        std::vector<double> row(size(width));
        Level across(out.width, 2 * (y1 - y0) + 3); // from row 2 y0 − 2 on
        for (int k = 0; k < across.height; ++k) {
            fill(mirrored(2 * y0 - 2 + k, height), row.data());
            double* to = across.row(k);
            for (int x = 0; x < out.width; ++x) {
                const auto in = [&](int dx) { return row[size(mirrored(2 * x + dx, width))]; };
                const bool inside = x > 0 && 2 * x + 2 < width;
                const double* p = row.data() + 2 * x;
                to[x] = inside
                            ? kBinomial[0] * p[0] + kBinomial[1] * (p[-1] + p[1]) + kBinomial[2] * (p[-2] + p[2])
                            : kBinomial[0] * p[0] + kBinomial[1] * (in(-1) + in(1)) + kBinomial[2] * (in(-2) + in(2));
            }
        }
        for (int y = y0; y < y1; ++y) {
            const int k = 2 * (y - y0);
            for (int x = 0; x < out.width; ++x)
                out.row(y)[x] = (kBinomial[0] * across.row(k + 2)[x] +
                                 kBinomial[1] * (across.row(k + 1)[x] + across.row(k + 3)[x]) +
                                 kBinomial[2] * (across.row(k)[x] + across.row(k + 4)[x])) /
                                256;
        }
    });
    return out;
}

Level halved(const Level& in) {
    return halved(in.width, in.height, {}, [&](int y, double* row) { std::copy_n(in.row(y), in.width, row); });
}

/// Where the pixels of a side of n lie in one of `from`: the two on both sides, and the part of the second.
struct Between {
    int first = 0, second = 0;
    double part = 0;
};

std::vector<Between> placesOf(int n, int from) {
    std::vector<Between> places(size(n));
    for (int i = 0; i < n; ++i) {
        const double p = std::clamp((i + 0.5) * from / n - 0.5, 0.0, from - 1.0);
        const int first = static_cast<int>(p);
        places[size(i)] = {first, std::min(first + 1, from - 1), p - first};
    }
    return places;
}

template <class Out>
BasicPlane<Out> enlarged(const Level& in, int width, int height) {
    BasicPlane<Out> out(width, height);
    const std::vector<Between> columns = placesOf(width, in.width), rows = placesOf(height, in.height);
    forBands(height, {}, [&](int y0, int y1) {
        std::vector<double> between(size(in.width));
        for (int y = y0; y < y1; ++y) {
            const auto [first, second, part] = rows[size(y)];
            for (int x = 0; x < in.width; ++x)
                between[size(x)] =
                    (1 - part) * static_cast<double>(in.row(first)[x]) + part * static_cast<double>(in.row(second)[x]);
            for (int x = 0; x < width; ++x) {
                const Between& at = columns[size(x)];
                out.row(y)[x] =
                    static_cast<Out>((1 - at.part) * between[size(at.first)] + at.part * between[size(at.second)]);
            }
        }
    });
    return out;
}

/// Divided by the largest value, times (1 − m)², m the mean of the other local maxima.
void normalize(Level& map) {
    const double top = *std::max_element(map.values.begin(), map.values.end());
    if (!(top > kRounding)) {
        std::ranges::fill(map.values, 0.0);
        return;
    }
    for (double& v : map.values) v /= top;
    double sum = 0, largest = 0;
    int peaks = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const double v = map.row(y)[x];
            if (v < 0.1) continue;
            bool peak = true, above = false;
            for (int ny = std::max(0, y - 1); peak && ny <= std::min(map.height - 1, y + 1); ++ny)
                for (int nx = std::max(0, x - 1); nx <= std::min(map.width - 1, x + 1); ++nx) {
                    peak = peak && v >= map.row(ny)[nx];
                    above = above || v > map.row(ny)[nx];
                }
            if (!peak || !above) continue;
            ++peaks;
            sum += v;
            largest = std::max(largest, v);
        }
    const double mean = peaks > 1 ? (sum - largest) / (peaks - 1) : 0;
    for (double& v : map.values) v *= (1 - mean) * (1 - mean);
}

void add(Level& sum, const Level& part) {
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += part.values[i];
}

/// One of the maps that a channel gives, at the level of the answer.
Level contrast(const Level& centre, const Level& surround, std::size_t level) {
    Level map = enlarged<double>(surround, centre.width, centre.height);
    for (std::size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::abs(centre.values[i] - map.values[i]);
    normalize(map);
    for (; level < kCoarsest; ++level) map = halved(map);
    return map;
}

/// Both phases of a Gabor filter of 9×9.
class Gabor {
public:
    explicit Gabor(double degrees) {
        const double sigma = 7.0 / 3.0, wave = 2 * std::numbers::pi / 7, turn = degrees * std::numbers::pi / 180;
        for (int y = -4; y <= 4; ++y)
            for (int x = -4; x <= 4; ++x) {
                const double gauss = std::exp(-(x * x + y * y) / (2 * sigma * sigma));
                const double u = wave * (x * std::cos(turn) + y * std::sin(turn));
                m_taps[size(9 * (y + 4) + x + 4)] = {gauss * std::cos(u), gauss * std::sin(u)};
            }
        for (const std::size_t phase : {0, 1}) {
            double mean = 0, all = 0;
            for (const auto& tap : m_taps) mean += tap[phase] / 81;
            for (auto& tap : m_taps) all += std::abs(tap[phase] -= mean);
            for (auto& tap : m_taps) tap[phase] /= all;
        }
    }

    /// The strength of such stripes in each pixel.
    Level operator()(const Level& in) const {
        Level out(in.width, in.height);
        std::vector<int> columns(size(in.width + 8));
        for (int i = 0; i < in.width + 8; ++i) columns[size(i)] = mirrored(i - 4, in.width);
        for (int y = 0; y < in.height; ++y) {
            std::vector<double> even(size(in.width)), odd(size(in.width)), row(columns.size());
            for (int k = 0; k < 9; ++k) {
                const double* from = in.row(mirrored(y + k - 4, in.height));
                for (std::size_t i = 0; i < row.size(); ++i) row[i] = from[columns[i]];
                for (std::size_t t = 0; t < 9; ++t) {
                    const auto [e, o] = m_taps[9 * size(k) + t];
                    for (std::size_t x = 0; x < even.size(); ++x) {
                        even[x] += e * row[x + t];
                        odd[x] += o * row[x + t];
                    }
                }
            }
            for (std::size_t x = 0; x < even.size(); ++x)
                out.row(y)[x] = std::sqrt(even[x] * even[x] + odd[x] * odd[x]);
        }
        return out;
    }

private:
    std::array<std::array<double, 2>, 81> m_taps{}; ///< even, odd
};

using Color = std::array<double, 3>;

Color seen(const float* pixel) {
    Color c{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double v = static_cast<double>(pixel[i]) * static_cast<double>(pixel[3]);
        c[i] = v > 0 ? std::min(v, 1.0) : 0; // NaN: 0
    }
    return c;
}

double intensityOf(const Color& c) { return (c[0] + c[1] + c[2]) / 3; }

/// Red against green and blue against yellow, of the hue alone.
std::array<double, 2> opponents(const Color& c, double dark) {
    const double i = intensityOf(c);
    if (!(i > dark)) return {0, 0};
    const double r = c[0] / i, g = c[1] / i, b = c[2] / i;
    const auto positive = [](double v) { return std::max(0.0, v); };
    return {positive(r - (g + b) / 2) - positive(g - (r + b) / 2),
            positive(b - (r + g) / 2) - positive((r + g) / 2 - std::abs(r - g) / 2 - b)};
}

/// Level 1 of intensity and both opponents; level 0 is as large as the picture, and not kept.
std::array<Level, 3> firstLevels(const Image& picture, const JobControl& job) {
    std::vector<double> brightest(size(picture.height), 0.0);
    parallelFor(brightest.size(), [&](std::size_t y) {
        for (int x = 0; x < picture.width; ++x)
            brightest[y] = std::max(brightest[y], intensityOf(seen(picture.pixel(x, static_cast<int>(y)))));
    });
    const double dark = *std::max_element(brightest.begin(), brightest.end()) / 10;
    const auto level = [&](const auto& of) {
        return halved(picture.width, picture.height, job, [&](int y, double* row) {
            for (int x = 0; x < picture.width; ++x) row[x] = of(seen(picture.pixel(x, y)));
        });
    };
    return {level(intensityOf), level([&](const Color& c) { return opponents(c, dark)[0]; }),
            level([&](const Color& c) { return opponents(c, dark)[1]; })};
}

/// S at the coarsest level.
Level coarseMap(const Image& picture, const JobControl& job) {
    std::array<Pyramid, kChannels> channels;
    std::array<Level, 3> first = firstLevels(picture, job);
    for (std::size_t c = 0; c < first.size(); ++c) {
        channels[c][1] = std::move(first[c]);
        for (std::size_t l = 2; l < channels[c].size(); ++l) channels[c][l] = halved(channels[c][l - 1]);
    }
    parallelFor(kOrientations * 7, [&](std::size_t i) { // the largest levels first
        job.throwIfStopped();
        const std::size_t turn = i % kOrientations, level = 2 + i / kOrientations;
        channels[3 + turn][level] = Gabor(45.0 * static_cast<double>(turn))(channels[0][level]);
    });
    std::array<std::array<Level, kScales.size()>, kChannels> maps;
    parallelFor(kChannels * kScales.size(), [&](std::size_t i) {
        job.throwIfStopped();
        const std::size_t scale = i / kChannels, c = i % kChannels;
        const auto [centre, surround] = kScales[scale];
        maps[c][scale] = contrast(channels[c][centre], channels[c][surround], centre);
    });
    const auto sumOf = [&](std::size_t c) {
        Level sum = maps[c][0];
        for (std::size_t scale = 1; scale < kScales.size(); ++scale) add(sum, maps[c][scale]);
        return sum;
    };
    Level map = sumOf(0), color = sumOf(1), turned(map.width, map.height);
    add(color, sumOf(2));
    for (std::size_t c = 3; c < kChannels; ++c) {
        Level one = sumOf(c);
        normalize(one);
        add(turned, one);
    }
    for (Level* part : {&map, &color, &turned}) normalize(*part);
    add(map, color);
    add(map, turned);
    for (double& v : map.values) v /= 3;
    return map;
}

/// With a Gaussian of a standard deviation of 1/16 of the width, cut at four of them, in no unit. Not on a coarser
/// copy, though that would be faster: far from all features the ratio of two tails decides.
Plane blurred(const Plane& in, const JobControl& job) {
    const double sigma = in.width / 16.0;
    const int reach = static_cast<int>(4 * sigma);
    std::vector<float> taps; // from the middle on
    for (int d = 0; d <= reach; ++d) taps.push_back(static_cast<float>(std::exp(-d * d / (2 * sigma * sigma))));
    Plane across(in.width, in.height), out = across;
    forBands(in.height, job, [&](int y0, int y1) {
        for (int y = y0; y < y1; ++y) {
            const float* from = in.row(y);
            float* to = across.row(y);
            for (int d = -reach; d <= reach; ++d) {
                const int first = std::max(0, -d), end = std::min(in.width, in.width - d);
                const float w = taps[size(std::abs(d))];
                for (int x = first; x < end; ++x) to[x] += w * from[x + d];
            }
        }
    });
    forBands(in.height, job, [&](int y0, int y1) {
        for (int y = y0; y < y1; ++y) {
            float* to = out.row(y);
            for (int k = std::max(0, y - reach); k <= std::min(in.height - 1, y + reach); ++k) {
                const float* from = across.row(k);
                const float w = taps[size(std::abs(k - y))];
                for (int x = 0; x < in.width; ++x) to[x] += w * from[x];
            }
        }
    });
    return out;
}

Lab labOf(const float* p) {
    return labFromSrgb({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
}

/// w of one pixel, by feature.
void weigh(const FeaturePictures& pictures, int x, int y, std::vector<double>& weight) {
    int drawn = 0;
    for (std::size_t f = 0; f < weight.size(); ++f) {
        weight[f] = pictures.alone[f].pixel(x, y)[3] > 0 ? 1 : 0;
        drawn += weight[f] > 0;
    }
    if (drawn < 2) return;
    const Lab whole = labOf(pictures.whole.pixel(x, y));
    double sum = 0;
    bool equal = false; // the first that is equal to the picture leaves nothing to those that are not
    for (std::size_t f = 0; f < weight.size(); ++f) {
        if (weight[f] == 0) continue;
        const double d = deltaE(whole, labOf(pictures.alone[f].pixel(x, y)));
        if (d == 0 && !equal) {
            equal = true;
            std::fill_n(weight.begin(), f, 0.0);
            sum = 0;
        }
        weight[f] = equal ? (d == 0 ? 1 : 0) : 1 / d;
        sum += weight[f];
    }
    for (double& w : weight) w /= sum;
}

/// Deals S out to the features that are drawn in each pixel.
void share(const FeaturePictures& pictures, const JobControl& job, FeatureSaliency& answer) {
    forBands(answer.map.height, job, [&](int y0, int y1) {
        std::vector<double> weight(pictures.alone.size());
        for (int y = y0; y < y1; ++y)
            for (int x = 0; x < answer.map.width; ++x) {
                weigh(pictures, x, y, weight);
                const auto s = static_cast<double>(answer.map.row(y)[x]);
                double left = s;
                for (std::size_t f = 0; f < weight.size(); ++f) {
                    answer.shared[f].row(y)[x] = static_cast<float>(weight[f] * s);
                    left -= weight[f] * s;
                }
                answer.rest.row(y)[x] = static_cast<float>(left);
            }
    });
}

/// Deals the rest out, and adds up what each feature has.
void spread(const JobControl& job, FeatureSaliency& answer) {
    const std::size_t features = answer.shared.size();
    const int height = answer.map.height;
    std::vector<std::vector<double>> sums(size((height + kBand - 1) / kBand), std::vector<double>(features, 0.0));
    forBands(height, job, [&](int y0, int y1) {
        std::vector<double>& sum = sums[size(y0 / kBand)];
        for (int y = y0; y < y1; ++y)
            for (int x = 0; x < answer.map.width; ++x) {
                double all = 0;
                for (const Plane& plane : answer.influence) all += static_cast<double>(plane.row(y)[x]);
                const double unit = all > 0 ? static_cast<double>(answer.rest.row(y)[x]) / all : 0;
                for (std::size_t f = 0; f < features; ++f) {
                    const double part = unit * static_cast<double>(answer.influence[f].row(y)[x]);
                    answer.spread[f].row(y)[x] = static_cast<float>(part);
                    sum[f] += part + static_cast<double>(answer.shared[f].row(y)[x]);
                }
            }
    });
    double all = 0;
    for (std::size_t f = 0; f < features; ++f) {
        for (const auto& sum : sums) answer.shares[f] += sum[f];
        all += answer.shares[f];
    }
    for (double& s : answer.shares) s = all > 0 ? s / all : 0;
}

} // namespace

Plane totalOf(const FeatureSaliency& saliency, std::size_t feature) {
    Plane total = saliency.shared.at(feature);
    const Plane& spread = saliency.spread.at(feature);
    for (std::size_t i = 0; i < total.values.size(); ++i) total.values[i] += spread.values[i];
    return total;
}

Plane saliencyMap(const Image& picture, const JobControl& job) {
    if (picture.rgba.empty()) return {picture.width, picture.height};
    return enlarged<float>(coarseMap(picture, job), picture.width, picture.height);
}

FeatureSaliency featureSaliency(const FeaturePictures& pictures, const JobControl& job) {
    const int width = pictures.whole.width, height = pictures.whole.height;
    for (const Image& image : pictures.alone)
        if (image.width != width || image.height != height)
            throw Error("the pictures differ in size", "2D feature saliency", "draw them in one size");
    FeatureSaliency answer;
    answer.shares.assign(pictures.alone.size(), 0.0);
    answer.map = saliencyMap(pictures.whole, job);
    answer.rest = Plane(width, height);
    answer.shared.assign(pictures.alone.size(), answer.rest);
    answer.spread = answer.shared;
    if (pictures.whole.rgba.empty()) {
        answer.influence = answer.shared;
        return answer;
    }
    share(pictures, job, answer);
    job.report(0.5);
    for (const Plane& plane : answer.shared) answer.influence.push_back(blurred(plane, job));
    spread(job, answer);
    job.report(1);
    return answer;
}

} // namespace pellucid
