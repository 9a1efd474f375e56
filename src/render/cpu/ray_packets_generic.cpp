// Ray packets for any processor, and the choice among those compiled.
#include <vector>

#include "render/cpu/ray_packets.inl"

namespace pellucid {

void renderTileGeneric(const PacketScene& scene, const PacketTile& tile) { renderTile(scene, tile); }
void layerTileGeneric(const PacketScene& scene, const PacketTile& tile) { layerTile(scene, tile); }

std::span<const PacketKernel> packetKernels() {
    static const std::vector<PacketKernel> kernels = [] {
        std::vector<PacketKernel> all{renderTileGeneric};
#ifdef PELLUCID_HAVE_AVX2_SWEEP
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) all.insert(all.begin(), renderTileAvx2);
#endif
        return all;
    }();
    return kernels;
}

PacketKernel layerKernel() {
#ifdef PELLUCID_HAVE_AVX2_SWEEP
    if (packetKernels().front() == renderTileAvx2) return layerTileAvx2;
#endif
    return layerTileGeneric;
}

} // namespace pellucid
