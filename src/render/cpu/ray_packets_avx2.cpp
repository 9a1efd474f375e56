// Ray packets for x86-64 processors with AVX2 and FMA; compiled with those switched on.
#include "render/cpu/ray_packets.inl"

namespace pellucid {

void renderTileAvx2(const PacketScene& scene, const PacketTile& tile) { renderTile(scene, tile); }
void layerTileAvx2(const PacketScene& scene, const PacketTile& tile) { layerTile(scene, tile); }

} // namespace pellucid
