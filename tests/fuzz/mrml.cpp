// Scenes of 3D Slicer. The volumes that they may name, a.nrrd and b.mha, are fixed; so is a scene that names itself.
#include "volume_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

struct SceneFolder : InputFolder {
    SceneFolder() {
        keep("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n\nabcdefghijklmnopqrstuvwx");
        keep("b.mha", "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\n"
                      "ElementDataFile = LOCAL\nabcdefghijklmnopqrstuvwx");
        keep("c.vti", "<MRML><Volume name=\"a\" storageNodeRef=\"s\"/><VolumeArchetypeStorage id=\"s\" "
                      "fileName=\"c.vti\"/></MRML>");
    }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const SceneFolder s_folder;
    openVolume(s_folder, data, size, ".mrml");
    return 0;
}
