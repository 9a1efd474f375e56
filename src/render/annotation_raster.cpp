#include "render/annotation_raster.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace pellucid {

namespace {

/// How much of each pixel a shape covers, within the part of the picture that it lies in.
class Coverage {
public:
    Coverage(const Image& image, const PixelBox& box)
        : m_left(clamped(box.left - 1, image.width)), m_top(clamped(box.top - 1, image.height)),
          m_right(clamped(box.right + 2, image.width)), m_bottom(clamped(box.bottom + 2, image.height)) {
        if (m_left < m_right && m_top < m_bottom)
            m_values.assign(static_cast<std::size_t>(m_right - m_left) * static_cast<std::size_t>(m_bottom - m_top), 0);
    }

    /// A line of round ends: the share of a pixel by its distance from the middle line.
    void addSegment(const Vec2& a, const Vec2& b, double radius) {
        constexpr double kPiece = 64; // so that the box around a long oblique line is not gone over
        const int pieces = std::max(1, static_cast<int>(glm::length(b - a) / kPiece));
        for (int i = 0; i < pieces; ++i)
            addPiece(a + (b - a) * (double(i) / pieces), a + (b - a) * (double(i + 1) / pieces), radius);
    }

    /// A convex area: by the distances from its sides.
    void addConvex(const std::vector<Vec2>& corners) {
        const std::size_t n = corners.size();
        double area = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2 &a = corners[i], &b = corners[(i + 1) % n];
            area += a.x * b.y - a.y * b.x;
        }
        const double turn = area < 0 ? -1 : 1;
        forEach(boxAround(corners).widened(1), [&](const Vec2& p) {
            double inside = 1;
            for (std::size_t i = 0; i < n && inside > 0; ++i) {
                const Vec2 &a = corners[i], way = corners[(i + 1) % n] - a;
                const double length = glm::length(way);
                if (!(length > 0)) continue;
                const double distance = turn * (way.x * (p.y - a.y) - way.y * (p.x - a.x)) / length;
                inside = std::min(inside, std::clamp(distance + 0.5, 0.0, 1.0));
            }
            return inside;
        });
    }

    /// Over the picture: colours are straight, so that alpha weighs them.
    void paint(Image& image, const Rgb& color, double alpha) const {
        const std::array<double, 3> ink{color.r, color.g, color.b};
        std::size_t i = 0;
        for (int y = m_top; y < m_bottom; ++y)
            for (int x = m_left; x < m_right; ++x) {
                const double over = alpha * m_values[i++];
                if (!(over > 0)) continue;
                float* pixel = image.pixel(x, y);
                const double below = pixel[3] * (1 - over), sum = over + below;
                for (std::size_t c = 0; c < 3; ++c)
                    pixel[c] = static_cast<float>((ink[c] * over + pixel[c] * below) / sum);
                pixel[3] = static_cast<float>(sum);
            }
    }

private:
    void addPiece(const Vec2& a, const Vec2& b, double radius) {
        const Vec2 way = b - a;
        const double length2 = glm::dot(way, way);
        forEach(boxAround({a, b}).widened(radius + 1), [&](const Vec2& p) {
            const double t = length2 > 0 ? std::clamp(glm::dot(p - a, way) / length2, 0.0, 1.0) : 0;
            const double distance = glm::length(p - a - way * t);
            // A line thinner than a pixel covers no more of it than it is thick.
            return std::clamp(radius + 0.5 - distance, 0.0, 1.0) * std::min(1.0, 2 * radius);
        });
    }

    static int clamped(double v, int limit) { return static_cast<int>(std::clamp(std::floor(v), 0.0, double(limit))); }

    /// Where several pieces of a shape meet in a pixel, the larger share counts: they are one shape.
    template <class Share>
    void forEach(const PixelBox& box, const Share& share) {
        const auto pixel = [](double v) { return static_cast<int>(std::clamp(v, -1.0, 1e6)); };
        const int left = std::max(m_left, pixel(std::floor(box.left))),
                  top = std::max(m_top, pixel(std::floor(box.top))),
                  right = std::min(m_right, pixel(std::ceil(box.right))),
                  bottom = std::min(m_bottom, pixel(std::ceil(box.bottom)));
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                float& value =
                    m_values[static_cast<std::size_t>(y - m_top) * static_cast<std::size_t>(m_right - m_left) +
                             static_cast<std::size_t>(x - m_left)];
                value = std::max(value, static_cast<float>(share(Vec2(x + 0.5, y + 0.5))));
            }
    }

    int m_left, m_top, m_right, m_bottom;
    std::vector<float> m_values;
};

void drawStrokes(Image& image, const Mark& mark, double width, const Rgb& color, double alpha) {
    Coverage coverage(image, extentOf(mark));
    for (const Polyline& stroke : strokesOf(mark)) {
        if (stroke.size() == 1) coverage.addSegment(stroke[0], stroke[0], width / 2);
        for (std::size_t i = 0; i + 1 < stroke.size(); ++i) coverage.addSegment(stroke[i], stroke[i + 1], width / 2);
    }
    coverage.paint(image, color, alpha);
}

} // namespace

void drawMarks(Image& image, const std::vector<Mark>& marks) {
    for (const Mark& mark : marks) {
        if (mark.kind == Mark::Kind::Area) {
            if (mark.points.size() < 3) continue;
            Coverage coverage(image, extentOf(mark));
            coverage.addConvex(mark.points);
            coverage.paint(image, mark.color, mark.alpha);
            continue;
        }
        if (mark.halo > 0)
            drawStrokes(image, mark, mark.width + 2 * mark.halo, mark.haloColor, kHaloAlpha * mark.alpha);
        drawStrokes(image, mark, mark.width, mark.color, mark.alpha);
    }
}

} // namespace pellucid
