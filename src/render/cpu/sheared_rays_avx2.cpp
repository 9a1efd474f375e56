// Rays in storage order for x86-64 processors with AVX2 and FMA; compiled with those switched on.
#include "render/cpu/sheared_rays.inl"

namespace pellucid {

void castTileAvx2(const ShearedScene& scene, const PacketTile& tile) { castTile(scene, tile); }
void warpTileAvx2(const ShearedScene& scene, const PacketTile& tile) { warpTile(scene, tile); }

} // namespace pellucid
