// Rays in storage order for any processor, and the choice among those compiled.
#include <vector>

#include "render/cpu/sheared_rays.inl"

namespace pellucid {

void castTileGeneric(const ShearedScene& scene, const PacketTile& tile) { castTile(scene, tile); }
void warpTileGeneric(const ShearedScene& scene, const PacketTile& tile) { warpTile(scene, tile); }

std::span<const ShearedKernels> shearedKernels() {
    static const std::vector<ShearedKernels> kernels = [] {
        std::vector<ShearedKernels> all{{castTileGeneric, warpTileGeneric}};
#ifdef PELLUCID_HAVE_AVX2_SWEEP
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
            all.insert(all.begin(), {castTileAvx2, warpTileAvx2});
#endif
        return all;
    }();
    return kernels;
}

} // namespace pellucid
