#include "ranks/block_volume.h"

#include "volume/excerpt.h"

namespace pellucid {

BlockVolume blockOf(const std::shared_ptr<const Volume>& whole, const Decomposition& blocks, int own,
                    const Int3& ghosts) {
    BlockVolume block;
    block.whole = whole->geometry();
    block.whole.referenceLength = block.whole.d0();
    block.blocks = blocks;
    block.own = own;
    block.region = widened(block.block(), ghosts, whole->dims());
    if (isEmpty(block.region)) return block;
    ExcerptPlan plan = planOf(block.region, whole->dims(), 1);
    plan.referenceLength = block.whole.d0();
    block.stored = std::make_shared<const Volume>(excerptOf(*whole, plan));
    return block;
}

} // namespace pellucid
