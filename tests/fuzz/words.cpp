// What people type into options and fields.
#include "base/color.h"
#include "base/text.h"
#include "fuzz_input.h"
#include "render/view_text.h"
#include "tf/formats/tf_file.h"
#include "tf/presets.h"
#include "volume/derived.h"
#include "volume/grid_axes.h"
#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = fuzz::textOf(data, size);
    succeeds([&] { parseRawLayout(text); });
    succeeds([&] { parseGridAxes(text); });
    succeeds([&] { parseDerivation(text); });
    succeeds([&] { viewFromText(text); });
    succeeds([&] { tfFromSpec(text); });
    succeeds([&] { tfFromPresetSpec(text); });
    succeeds([&] { require(rgbFromHex(hexFromRgb(rgbFromHex(text))) == rgbFromHex(text), "a colour stays"); });
    const std::string shown = printable(text);
    require(printable(shown) == shown, "what can be shown stays as it is");
    return 0;
}
