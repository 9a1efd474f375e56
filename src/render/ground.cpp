// Draws a height field: two triangles for each cell of its grid, nearest first by a depth buffer. Bands of rows are
// drawn side by side; within a band the triangles come in their order, so that no bit depends on threads.
#include "render/ground.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/check.h"
#include "base/parallel.h"
#include "render/ground_raster.h"
#include "tf/terrain.h"
#include "volume/voxel_colors.h"

namespace pellucid {

namespace {

constexpr int kBand = 24;          ///< rows of the picture that are drawn by one thread
constexpr int kBlock = 8;          ///< cells along each side of a block that is looked at, or not, as one
constexpr double kSharpest = 0.75; ///< pixels: cells are not drawn smaller than this
constexpr double kHair = 1e-6;     ///< of a triangle: what neighbours may overlap, so that no pixel is missed
constexpr float kInTheShade = 0.4f, kUnderside = 0.45f;

/// Of (x, y) among rows of `width`.
std::size_t indexOf(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// A vertex on the screen. `near` grows toward the eye and goes linearly over the screen: the inverse of the depth in
/// perspective, the negative depth otherwise.
struct Vertex {
    float x = 0, y = 0; ///< pixels of the window
    double near = 0;
    float height = 0; ///< 0 … 1: lowest and highest of the colours
    float shade = 1;  ///< brightness, > 0; negative on the underside
};
enum class Kind : std::uint8_t { None, Behind, Seen }; ///< no height, behind the eye

class Raster {
public:
    Raster(const Ground& ground, const Camera& camera, const GroundWindow& window)
        : m_ground(ground), m_window(window), m_perspective(camera.projection == Projection::Perspective) {
        m_perPixel = 2 * camera.halfHeight() / window.pictureHeight;
        m_perColumn = m_perPixel * window.pixelAspect;
        const Vec3 axes[3] = {camera.right(), camera.trueUp(), camera.forward()};
        const auto inView = [&](const Vec3& v) {
            return Vec3(glm::dot(v, axes[0]), glm::dot(v, axes[1]), glm::dot(v, axes[2]));
        };
        m_origin = inView(ground.origin - camera.eye);
        m_stepX = inView(ground.stepX);
        m_stepY = inView(ground.stepY);
        m_up = inView(ground.up);
        const Vec3 normal = glm::cross(ground.stepX, ground.stepY);
        m_rightHanded = glm::dot(normal, ground.up) >= 0;
        const Vec3 alongX = glm::normalize(ground.stepX), alongY = glm::normalize(ground.stepY);
        const Vec3 flat = glm::normalize(m_rightHanded ? normal : -normal);
        // From the upper left of the map, where y goes up on it, halfway up the sky.
        m_toSun = glm::normalize(glm::normalize(alongY - alongX) + flat);
        m_flatBrightness = glm::dot(flat, m_toSun);
        m_nearest = 1e-4 * (glm::length(ground.stepX) * ground.nx + glm::length(ground.stepY) * ground.ny);
        chooseStride();
        m_nx = (ground.nx - 2) / m_stride + 2;
        m_ny = (ground.ny - 2) / m_stride + 2;
        m_vertices.resize(indexOf(0, m_ny, m_nx));
        m_kinds.resize(m_vertices.size());
        m_blocksX = (m_nx - 2) / kBlock + 1;
        m_blocksY = (m_ny - 2) / kBlock + 1;
        m_blockRows.resize(indexOf(0, m_blocksY, m_blocksX));
    }

    void project(const JobControl& job) {
        parallelFor(static_cast<std::size_t>(m_ny), [&](std::size_t row) {
            job.throwIfStopped();
            projectRow(static_cast<int>(row));
        });
        parallelFor(static_cast<std::size_t>(m_blocksY), [&](std::size_t by) {
            for (int bx = 0; bx < m_blocksX; ++bx) {
                const int row = static_cast<int>(by);
                m_blockRows[indexOf(bx, row, m_blocksX)] = rowsOfBlock(bx, row);
            }
        });
    }

    /// Rows [y0, y1) of the picture. Fills nearest, heights and shades, of width × rows each.
    struct Band {
        int y0, y1;
        std::vector<double> near;
        std::vector<float> height, shade;
    };
    Band drawBand(int y0, int y1) const {
        const std::size_t pixels = indexOf(0, y1 - y0, m_window.width);
        Band band{y0, y1, std::vector<double>(pixels, kNothing), std::vector<float>(pixels),
                  std::vector<float>(pixels)};
        for (int by = 0; by < m_blocksY; ++by)
            for (int bx = 0; bx < m_blocksX; ++bx) {
                const Rows& rows = m_blockRows[indexOf(bx, by, m_blocksX)];
                if (rows.low > static_cast<float>(y1) || rows.high < static_cast<float>(y0)) continue;
                const int endX = std::min((bx + 1) * kBlock, m_nx - 1), endY = std::min((by + 1) * kBlock, m_ny - 1);
                for (int j = by * kBlock; j < endY; ++j)
                    for (int i = bx * kBlock; i < endX; ++i) drawCell(i, j, band);
            }
        return band;
    }
    double depthOf(double near) const { return m_perspective ? 1 / near : -near; }

    static constexpr double kNothing = -std::numeric_limits<double>::infinity();

private:
    struct Rows {
        float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
        void add(float y) {
            low = std::min(low, y);
            high = std::max(high, y);
        }
    };

    std::size_t index(int i, int j) const { return indexOf(i, j, m_nx); }
    int sampleX(int i) const { return std::min(i * m_stride, m_ground.nx - 1); }
    int sampleY(int j) const { return std::min(j * m_stride, m_ground.ny - 1); }
    float heightAt(int x, int y) const { return m_ground.heights[indexOf(x, y, m_ground.nx)]; }

    /// Every so many samples are drawn, where their cells would be less than a pixel wide.
    void chooseStride() {
        double nearest = 1;
        if (m_perspective) {
            nearest = std::numeric_limits<double>::infinity();
            for (int corner = 0; corner < 4; ++corner)
                nearest = std::min(nearest, (m_origin + (corner & 1 ? m_ground.nx - 1.0 : 0.0) * m_stepX +
                                             (corner & 2 ? m_ground.ny - 1.0 : 0.0) * m_stepY)
                                                .z);
            nearest = std::max(nearest, m_nearest);
        }
        const double cell = std::max(glm::length(m_ground.stepX), glm::length(m_ground.stepY));
        const double pixels = cell / (m_perPixel * nearest);
        const int most = std::max(1, std::min(m_ground.nx, m_ground.ny) / 2);
        m_stride = static_cast<int>(std::clamp(kSharpest / pixels, 1.0, static_cast<double>(most)));
    }

    Vec3 inView(int x, int y) const {
        return m_origin + static_cast<double>(x) * m_stepX + static_cast<double>(y) * m_stepY +
               static_cast<double>(heightAt(x, y)) * m_up;
    }

    /// Rise per sample along x or y, by the neighbours that have a height.
    double slope(int x, int y, int dx, int dy) const {
        const int x0 = std::max(0, x - dx * m_stride), x1 = std::min(m_ground.nx - 1, x + dx * m_stride),
                  y0 = std::max(0, y - dy * m_stride), y1 = std::min(m_ground.ny - 1, y + dy * m_stride);
        double below = heightAt(x0, y0), above = heightAt(x1, y1);
        int way = (x1 - x0) + (y1 - y0);
        if (std::isnan(below)) {
            below = heightAt(x, y);
            way -= (x - x0) + (y - y0);
        }
        if (std::isnan(above)) {
            above = heightAt(x, y);
            way -= (x1 - x) + (y1 - y);
        }
        return way > 0 ? (above - below) / way : 0;
    }

    float brightness(int x, int y) const {
        const Vec3 alongX = m_ground.stepX + slope(x, y, 1, 0) * m_ground.up,
                   alongY = m_ground.stepY + slope(x, y, 0, 1) * m_ground.up;
        Vec3 normal = glm::cross(alongX, alongY);
        if (!m_rightHanded) normal = -normal;
        const double lit = std::max(0.0, glm::dot(normal, m_toSun) / (glm::length(normal) * m_flatBrightness));
        const double shaded = static_cast<double>(kInTheShade) + (1 - static_cast<double>(kInTheShade)) * lit;
        return static_cast<float>(1 + m_ground.relief * (shaded - 1));
    }

    Vertex projected(const Vec3& view, float height, float shade) const {
        const double across = m_perspective ? view.z : 1;
        return {static_cast<float>(m_window.pictureWidth / 2 + view.x / (m_perColumn * across) - m_window.left),
                static_cast<float>(m_window.pictureHeight / 2 - view.y / (m_perPixel * across) - m_window.top),
                m_perspective ? 1 / view.z : -view.z, height, shade};
    }

    void projectRow(int j) {
        const int y = sampleY(j);
        const double perHeight = 1 / (m_ground.hi - m_ground.lo);
        for (int i = 0; i < m_nx; ++i) {
            const int x = sampleX(i);
            const std::size_t at = index(i, j);
            const float h = heightAt(x, y);
            if (!std::isfinite(h)) continue; // stays None
            const Vec3 view = inView(x, y);
            const auto t = static_cast<float>((static_cast<double>(h) - m_ground.lo) * perHeight);
            if (m_perspective && view.z <= m_nearest) {
                m_kinds[at] = Kind::Behind;
                m_vertices[at] = {0, 0, 0, t, brightness(x, y)};
                continue;
            }
            m_kinds[at] = Kind::Seen;
            m_vertices[at] = projected(view, t, brightness(x, y));
        }
    }

    Rows rowsOfBlock(int bx, int by) const {
        Rows rows;
        for (int j = by * kBlock; j <= std::min((by + 1) * kBlock, m_ny - 1); ++j)
            for (int i = bx * kBlock; i <= std::min((bx + 1) * kBlock, m_nx - 1); ++i) {
                const std::size_t at = index(i, j);
                if (m_kinds[at] == Kind::Seen) rows.add(m_vertices[at].y);
                if (m_kinds[at] == Kind::Behind) return {-1e30f, 1e30f}; // where its cells get to is seen later
            }
        return rows;
    }

    void drawCell(int i, int j, Band& band) const {
        const std::array<std::size_t, 4> at{index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)};
        Rows rows;
        bool whole = true;
        for (const std::size_t v : at) {
            whole = whole && m_kinds[v] == Kind::Seen;
            rows.add(m_vertices[v].y);
        }
        if (whole && (rows.low > static_cast<float>(band.y1) || rows.high < static_cast<float>(band.y0))) return;
        const std::array<std::array<int, 2>, 4> place{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
        for (const auto& corners : {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{0, 2, 3}}) {
            int seen = 0, behind = 0;
            for (const std::size_t c : corners) {
                seen += m_kinds[at[c]] == Kind::Seen ? 1 : 0;
                behind += m_kinds[at[c]] == Kind::Behind ? 1 : 0;
            }
            if (seen == 3)
                draw(m_vertices[at[corners[0]]], m_vertices[at[corners[1]]], m_vertices[at[corners[2]]], band);
            else if (seen > 0 && seen + behind == 3)
                drawCut({place[corners[0]], place[corners[1]], place[corners[2]]}, band);
        }
    }

    /// A triangle of which a part lies behind the eye.
    void drawCut(const std::array<std::array<int, 2>, 3>& corners, Band& band) const {
        std::array<Vertex, 4> cut;
        std::size_t count = 0;
        for (std::size_t n = 0; n < 3; ++n) {
            const auto &p = corners[n], &q = corners[(n + 1) % 3];
            const Vec3 from = inView(sampleX(p[0]), sampleY(p[1])), to = inView(sampleX(q[0]), sampleY(q[1]));
            const Vertex &a = m_vertices[index(p[0], p[1])], &b = m_vertices[index(q[0], q[1])];
            if (from.z > m_nearest) cut[count++] = projected(from, a.height, a.shade);
            if ((from.z > m_nearest) == (to.z > m_nearest)) continue;
            const double f = (m_nearest - from.z) / (to.z - from.z);
            const auto part = static_cast<float>(f);
            cut[count++] = projected(from + f * (to - from), a.height + part * (b.height - a.height),
                                     a.shade + part * (b.shade - a.shade));
        }
        for (std::size_t n = 2; n < count; ++n) draw(cut[0], cut[n - 1], cut[n], band);
    }

    static double edge(const Vertex& a, const Vertex& b, double x, double y) {
        const double ax = a.x, ay = a.y;
        return (b.x - ax) * (y - ay) - (b.y - ay) * (x - ax);
    }

    void draw(const Vertex& a, const Vertex& b, const Vertex& c, Band& band) const {
        // Pixels whose middles may lie in it.
        const auto within = [](float v, int low, int high) {
            return static_cast<int>(std::clamp(v, static_cast<float>(low), static_cast<float>(high)));
        };
        const float lowX = std::min({a.x, b.x, c.x}), highX = std::max({a.x, b.x, c.x}),
                    lowY = std::min({a.y, b.y, c.y}), highY = std::max({a.y, b.y, c.y});
        if (highX < 0 || lowX > static_cast<float>(m_window.width)) return;
        const int x0 = within(std::ceil(lowX - 0.5f), 0, m_window.width),
                  x1 = within(std::floor(highX - 0.5f) + 1, 0, m_window.width),
                  y0 = within(std::ceil(lowY - 0.5f), band.y0, band.y1),
                  y1 = within(std::floor(highY - 0.5f) + 1, band.y0, band.y1);
        if (x0 >= x1 || y0 >= y1) return;
        const double area = edge(a, b, c.x, c.y);
        if (area == 0) return; // edge-on
        // Rows of the picture go down: what runs against the clock on the map does so on the screen from above.
        const float side = (area < 0) == m_rightHanded ? 1.0f : -1.0f;
        const double perArea = 1 / area;
        // What a vertex has of a pixel, and what a pixel to the right changes.
        const double moreOfA = (static_cast<double>(b.y) - c.y) * perArea,
                     moreOfB = (static_cast<double>(c.y) - a.y) * perArea;
        for (int y = y0; y < y1; ++y) {
            const double firstOfA = edge(b, c, x0 + 0.5, y + 0.5) * perArea,
                         firstOfB = edge(c, a, x0 + 0.5, y + 0.5) * perArea;
            for (int x = x0; x < x1; ++x) {
                const double ofA = firstOfA + (x - x0) * moreOfA, ofB = firstOfB + (x - x0) * moreOfB;
                const double ofC = 1 - ofA - ofB;
                if (ofA < -kHair || ofB < -kHair || ofC < -kHair) continue;
                const double near = ofA * a.near + ofB * b.near + ofC * c.near;
                const std::size_t at = indexOf(x, y - band.y0, m_window.width);
                if (!(near > band.near[at])) continue;
                band.near[at] = near;
                double wa = ofA, wb = ofB, wc = ofC;
                if (m_perspective) {
                    wa *= a.near / near;
                    wb *= b.near / near;
                    wc *= c.near / near;
                }
                const auto mean = [&](double first, double second, double third) {
                    return static_cast<float>(wa * first + wb * second + wc * third);
                };
                band.height[at] = mean(a.height, b.height, c.height);
                band.shade[at] = side * mean(a.shade, b.shade, c.shade);
            }
        }
    }

    const Ground& m_ground;
    const GroundWindow& m_window;
    bool m_perspective, m_rightHanded = true;
    double m_perPixel = 1, m_perColumn = 1;     ///< world units down and across, at depth 1 in perspective
    Vec3 m_origin, m_stepX, m_stepY, m_up;      ///< right, up and ahead of the camera
    Vec3 m_toSun;                               ///< world
    double m_flatBrightness = 1, m_nearest = 0; ///< depth from which on vertices are seen
    int m_stride = 1, m_nx = 0, m_ny = 0;       ///< samples per vertex, vertices
    int m_blocksX = 0, m_blocksY = 0;
    std::vector<Vertex> m_vertices;
    std::vector<Kind> m_kinds;
    std::vector<Rows> m_blockRows;
};

/// Colours of heights, in equal steps.
std::vector<Rgb> tableOf(ColorAt colorAt) {
    constexpr std::size_t kEntries = 4096;
    std::vector<Rgb> table(kEntries);
    for (std::size_t i = 0; i < kEntries; ++i) table[i] = colorAt(static_cast<double>(i) / (kEntries - 1));
    return table;
}

std::uint32_t packed(const Rgb& color, double shade, double depth, const DepthFade& fade) {
    const double bright = shade < 0 ? -shade * static_cast<double>(kUnderside) : shade;
    const double cue =
        fade.strength > 0 ? fade.strength * std::clamp((depth - fade.from) * fade.perDepth, 0.0, 1.0) : 0;
    const auto byte = [&](double c, double behind) {
        c = std::min(1.0, c * bright);
        return static_cast<std::uint8_t>((c + cue * (behind - c)) * 255 + 0.5);
    };
    return VoxelColors::pack(byte(color.r, fade.color.r), byte(color.g, fade.color.g), byte(color.b, fade.color.b));
}

} // namespace

GroundPicture rasterizeGround(const Ground& ground, const Camera& camera, double depthOfZero,
                              const GroundWindow& window, const DepthFade& fade, const JobControl& job) {
    PELLUCID_CHECK(ground.nx >= 2 && ground.ny >= 2 && window.width > 0 && window.height > 0 &&
                   ground.heights.size() == indexOf(0, ground.ny, ground.nx) && ground.lo < ground.hi);
    const std::vector<Rgb> colors = tableOf(groundColors(ground.colorMap));
    GroundPicture picture;
    picture.width = window.width;
    picture.height = window.height;
    const std::size_t pixels = indexOf(0, window.height, window.width);
    picture.rgba.assign(pixels, 0);
    picture.depth.assign(pixels, GroundPicture::kNone);

    Raster raster(ground, camera, window);
    raster.project(job);
    const int bands = (window.height + kBand - 1) / kBand;
    parallelFor(static_cast<std::size_t>(bands), [&](std::size_t n) {
        job.throwIfStopped();
        const int y0 = static_cast<int>(n) * kBand;
        const Raster::Band band = raster.drawBand(y0, std::min(y0 + kBand, window.height));
        const std::size_t first = indexOf(0, y0, window.width);
        for (std::size_t i = 0; i < band.near.size(); ++i) {
            if (band.near[i] == Raster::kNothing) continue;
            const double depth = raster.depthOf(band.near[i]) - depthOfZero;
            const double t = std::clamp(static_cast<double>(band.height[i]), 0.0, 1.0);
            const Rgb& color = colors[static_cast<std::size_t>(t * static_cast<double>(colors.size() - 1) + 0.5)];
            picture.rgba[first + i] = packed(color, static_cast<double>(band.shade[i]), depth, fade);
            picture.depth[first + i] = static_cast<float>(depth);
        }
    });
    return picture;
}

bool showsGround(const RenderSettings& settings) { return settings.ground != nullptr && isColored(settings.mode); }

GroundPicture groundOf(const RenderSettings& settings, const Camera& camera, const Geometry& geometry,
                       const GroundWindow& window, const JobControl& job) {
    const double radius = geometry.radius();
    const DepthFade fade{settings.light.depthCue, settings.background.value_or(Rgb{}), -radius, 1 / (2 * radius)};
    return rasterizeGround(*settings.ground, camera, glm::dot(geometry.boxCenter() - camera.eye, camera.forward()),
                           window, fade, {job.stop, {}});
}

} // namespace pellucid
