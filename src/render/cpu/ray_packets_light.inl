// Light on what eight rays meet: gradients of the intensity, and what they make of colours (docs/method.md, "Light").
#pragma once

#include "render/cpu/ray_packets_samples.inl"

namespace pellucid {
namespace {

/// How eight colours c become c·scale + add, held in [0, 1], times dim, mixed with `cue` parts of the cue's colour.
struct Shade {
    Vec8 scale, add, dim, cue;
};

class Lighting {
public:
    Lighting(const PacketScene& s, const Samples& samples) : m_s(s), m_samples(samples) {}

    /// Of the lanes in `bits`; codes per voxel.
    void gradientsAt(const Vec8 (&position)[3], unsigned bits, Vec8 (&gradient)[3]) const {
        const Cells c = m_samples.cellsAt(position);
        const Int8 index = m_samples.indexOf(c);
        for (; bits != 0; bits &= bits - 1) {
            const int n = __builtin_ctz(bits);
            bool inner = m_s.valid == nullptr;
            for (int a = 0; a < 3; ++a) inner = inner && c.at[a][n] >= 1 && c.at[a][n] < m_s.dims[a] - 2;
            float g[3];
            if (inner)
                innerGradient(index[n], c.fraction[0][n], c.fraction[1][n], c.fraction[2][n], g);
            else
                outerGradient(position[0][n], position[1][n], position[2][n], g);
            for (int a = 0; a < 3; ++a) gradient[a][n] = g[a];
        }
    }

    /// Intensity per d0 along the camera's axes.
    void toCamera(const Vec8 (&gradient)[3], Vec8 (&inCamera)[3]) const {
        const auto& m = m_s.light.cameraFromGradient;
        for (int row = 0; row < 3; ++row)
            inCamera[row] = m[row][0] * gradient[0] + m[row][1] * gradient[1] + m[row][2] * gradient[2];
    }
    static Vec8 lengthOf(const Vec8 (&v)[3]) { return squareRoot(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

    /// What is left of optical depth where the gradient has the length g.
    Vec8 depthShare(Vec8 g) const { return 1.0f - m_s.light.gradientOpacity * (1.0f - least(all(1), g * (1 / 0.05f))); }

    /// `view` and `gradient` in camera coordinates, the first a unit vector toward the viewer; `position` in voxels,
    /// `depth` along the view.
    Shade shadeOf(const Vec8 (&view)[3], const Vec8 (&gradient)[3], const Vec8 (&position)[3], Vec8 depth,
                  unsigned bits) const {
        const PacketLight& l = m_s.light;
        Shade shade{all(1), Vec8{}, all(1), Vec8{}};
        const Vec8 g = lengthOf(gradient);
        const Int8 surface = g >= 1e-6f; // inside a homogeneous region there is none to light
        const Vec8 perG = 1.0f / most(g, all(1e-6f));
        Vec8 normal[3], facing = Vec8{};
        for (int a = 0; a < 3; ++a) {
            normal[a] = gradient[a] * perG;
            facing += normal[a] * view[a];
        }
        if (l.shaded) {
            Vec8 toward = Vec8{}, lightToView = Vec8{};
            for (int a = 0; a < 3; ++a) {
                const Vec8 turned = facing < 0 ? -normal[a] : normal[a];
                toward += turned * l.toward[a];
                lightToView += view[a] * l.toward[a];
            }
            // R·V with R = 2(N·L)N − L
            Vec8 mirrored = 2.0f * toward * positive(facing) - lightToView;
            mirrored = toward > 0 ? least(all(1), most(Vec8{}, mirrored)) : Vec8{};
            shade.scale = surface ? l.ambient + l.diffuse * most(Vec8{}, toward) : all(1);
            if (!none(mirrored > l.specularFrom)) shade.add = surface & (toward > 0) ? specularAt(mirrored) : Vec8{};
        }
        if (l.silhouettes > 0) {
            Vec8 edge = 1.0f - least(all(1), positive(facing));
            edge *= edge;
            edge *= edge;
            const Vec8 dark = l.silhouettes * least(all(1), g * (1 / 0.02f)) * edge;
            shade.dim = surface ? 1.0f - dark : all(1);
        }
        if (l.openness) shade.dim *= 1.0f - l.occlusion * (1.0f - opennessAt(position, bits));
        if (l.depthCue > 0) shade.cue = l.depthCue * least(all(1), most(Vec8{}, (depth - l.cueFrom) * l.cuePerDepth));
        return shade;
    }

    /// `rgb` premultiplied by `weight`, in lane n of `shade`.
    Vec4 lit(Vec4 rgb, float weight, const Shade& shade, int n) const {
        const Vec4 most = Vec4{} + weight;
        Vec4 c = rgb * shade.scale[n] + shade.add[n] * weight;
        c = c < most ? c : most;
        c *= shade.dim[n];
        const Vec4 cue{m_s.light.cueColor[0], m_s.light.cueColor[1], m_s.light.cueColor[2], 0};
        return c + shade.cue[n] * (cue * weight - c);
    }

private:
    static Vec8 floatsAt(const float* from, Int8 x) {
        return reinterpret_cast<Vec8>(gathered(reinterpret_cast<const int*>(from), x));
    }
    Vec8 specularAt(Vec8 cosine) const {
        const Vec8 entry = cosine * static_cast<float>(kSpecularEntries);
        const Int8 e = least(toInt(entry), Int8{} + (kSpecularEntries - 1));
        const Vec8 below = floatsAt(m_s.light.specular, e), above = floatsAt(m_s.light.specular + 1, e);
        return below + (entry - toFloat(e)) * (above - below);
    }

    /// Central differences of the trilinear intensity over one voxel on each side, where all that takes is inside:
    /// rows of four along x, weighted along the two other axes.
    void innerGradient(std::int64_t p, float fx, float fy, float fz, float (&g)[3]) const {
        const std::int64_t y = m_samples.alongY(), z = m_samples.alongZ();
        const auto rowAt = [this](std::int64_t at) { return m_samples.rowAround(at); };
        const float gx = 1 - fx, gy = 1 - fy, gz = 1 - fz;
        const Vec4 r00 = rowAt(p), r10 = rowAt(p + y), r01 = rowAt(p + z), r11 = rowAt(p + y + z);
        const Vec4 onX = gz * (gy * r00 + fy * r10) + fz * (gy * r01 + fy * r11);
        const Vec4 onY = gz * (gy * (r10 - rowAt(p - y)) + fy * (rowAt(p + 2 * y) - r00)) +
                         fz * (gy * (r11 - rowAt(p - y + z)) + fy * (rowAt(p + 2 * y + z) - r01));
        const Vec4 onZ = gy * (gz * (r01 - rowAt(p - z)) + fz * (rowAt(p + 2 * z) - r00)) +
                         fy * (gz * (r11 - rowAt(p - z + y)) + fz * (rowAt(p + 2 * z + y) - r10));
        g[0] = 0.5f * (gx * (onX[2] - onX[0]) + fx * (onX[3] - onX[1]));
        g[1] = 0.5f * (gx * onY[1] + fx * onY[2]);
        g[2] = 0.5f * (gx * onZ[1] + fx * onZ[2]);
    }
    void outerGradient(float x, float y, float z, float (&g)[3]) const {
        g[0] = 0.5f * (m_samples.codeAt(x + 1, y, z) - m_samples.codeAt(x - 1, y, z));
        g[1] = 0.5f * (m_samples.codeAt(x, y + 1, z) - m_samples.codeAt(x, y - 1, z));
        g[2] = 0.5f * (m_samples.codeAt(x, y, z + 1) - m_samples.codeAt(x, y, z - 1));
    }

    Vec8 opennessAt(const Vec8 (&position)[3], unsigned bits) const {
        const PacketLight& l = m_s.light;
        Vec8 result = all(1);
        for (; bits != 0; bits &= bits - 1) {
            const int n = __builtin_ctz(bits);
            int at[3], next[3];
            float f[3];
            for (int a = 0; a < 3; ++a) {
                const float last = static_cast<float>(l.opennessDims[a] - 1);
                float p = position[a][n] * l.cellOfVoxel + l.cellOfVoxelOffset;
                p = p < 0 ? 0 : (p > last ? last : p);
                at[a] = static_cast<int>(p);
                f[a] = p - static_cast<float>(at[a]);
                next[a] = at[a] + 1 < l.opennessDims[a] ? at[a] + 1 : at[a];
            }
            float sum = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const int i = corner & 1 ? next[0] : at[0], j = corner & 2 ? next[1] : at[1],
                          k = corner & 4 ? next[2] : at[2];
                const float w =
                    (corner & 1 ? f[0] : 1 - f[0]) * (corner & 2 ? f[1] : 1 - f[1]) * (corner & 4 ? f[2] : 1 - f[2]);
                sum +=
                    w * static_cast<float>(
                            l.openness[(static_cast<std::int64_t>(k) * l.opennessDims[1] + j) * l.opennessDims[0] + i]);
            }
            result[n] = sum * (1 / 255.0f);
        }
        return result;
    }

    const PacketScene& m_s;
    const Samples& m_samples;
};

} // namespace
} // namespace pellucid
