#include "options/saliency_options.h"

#include <cmath>

#include "base/error.h"

namespace pellucid::cli {

void SaliencyInput::add(CLI::App& app) {
    const char* const group = "Saliency";
    options.add(app, group);
    shares.add(app, group);
}

void SaliencyInput::applyTo(SceneInputs& inputs) const {
    const VwsOptions& given = shares.values();
    const bool has1 = shares.has("u1"), has2 = shares.has("u2");
    if (has1 && has2 && std::abs(given.u1 + given.u2 - 1) > 1e-9)
        throw UsageError("the shares of brightness and saturation do not sum to 1", "--u1 and --u2",
                         "give two numbers that do, or one of them");
    inputs.session.measure.edit([&](MeasureSettings& m) {
        options.applyTo(m.saliency);
        if (has1) m.vws = {given.u1, has2 ? given.u2 : 1 - given.u1};
        if (has2 && !has1) m.vws = {1 - given.u2, given.u2};
    });
}

} // namespace pellucid::cli
