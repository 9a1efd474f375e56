// Seeded random cases of everything that an engine must measure: volume, spacing, camera, transfer function.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>

#include "render/view.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::test {

/// Draws by hand from std::mt19937, because the distributions of std differ between libraries.
class Random {
public:
    explicit Random(std::uint32_t seed) : m_bits(seed) {}

    double unit() { ///< [0, 1), 32 bits
        return static_cast<double>(m_bits()) / 4294967296.0;
    }
    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
    int below(int count) { return static_cast<int>(unit() * count); } ///< 0 … count − 1
    bool chance(double probability) { return unit() < probability; }
    double sign() { return chance(0.5) ? 1.0 : -1.0; }

private:
    std::mt19937 m_bits;
};

struct RandomCase {
    std::uint32_t number = 0;
    std::string volumeKind, cameraKind, tfKind; ///< what to print beside a figure
    std::shared_ptr<const Volume> volume;       ///< 12 to 48 voxels per axis
    Camera camera;                              ///< outside the box, valid for the volume
    TransferFunction tf;                        ///< 1 to 5 features, at least one opacity above 0
    Clipping clipping;                          ///< none, unless asked for

    View view() const { return {camera, clipping}; }
    std::string describe() const; ///< one line: number, kinds, dims, spacing
};

/// Case `number`: the same on every machine but for the last bits of sin and exp. Each kind of volume, camera and
/// transfer function comes equally often in a run of consecutive numbers, in independent orders. `size` scales the
/// number of voxels along each axis, for tests that measure one case many times.
RandomCase randomCase(std::uint32_t number, double size = 1);

/// What a case may have besides; the rest of it stays as it is.
struct Variant {
    bool affine = false;  ///< the grid turned at random, mirrored or not, sheared by 5 to 20 degrees or not
    bool clipped = false; ///< a part of the box and one to three oblique planes
    bool faint = false;   ///< another such part, outside of which optical depths are 2 to 60 % of their own
};
RandomCase randomCase(std::uint32_t number, double size, const Variant& variant);

} // namespace pellucid::test
