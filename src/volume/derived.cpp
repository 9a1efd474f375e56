#include "volume/derived.h"

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

std::string Derivation::text() const {
    switch (kind) {
    case Kind::Gradient:
        return "gradient:" + of;
    case Kind::Volatility:
        return "volatility:" + of + ":" + std::to_string(frames);
    case Kind::Difference:
        return "difference:" + of + ":" + std::to_string(reference);
    }
    return of;
}

std::optional<Derivation> parseDerivation(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return {};
    const std::string kind = text.substr(0, colon);
    Derivation d;
    if (kind == "gradient")
        d.kind = Derivation::Kind::Gradient;
    else if (kind == "volatility")
        d.kind = Derivation::Kind::Volatility;
    else if (kind == "difference")
        d.kind = Derivation::Kind::Difference;
    else
        return {};
    const auto fail = [&](const std::string& what) {
        return UsageError(what, "variable " + text,
                          "give gradient:NAME, volatility:NAME:FRAMES or difference:NAME:FRAME");
    };
    d.of = text.substr(colon + 1);
    if (d.kind != Derivation::Kind::Gradient) {
        // What it is made of may be derived itself: the number is what stands last.
        const std::size_t last = d.of.rfind(':');
        std::int64_t number = 0;
        if (last == std::string::npos || !parseNumber(d.of.substr(last + 1), number)) throw fail("it has no number");
        constexpr std::int64_t kMost = 1'000'000'000;
        const bool volatility = d.kind == Derivation::Kind::Volatility;
        if (number < (volatility ? 1 : 0) || number > kMost) throw fail("the number is out of range");
        (volatility ? d.frames : d.reference) = static_cast<int>(number);
        d.of.resize(last);
    }
    if (d.of.empty()) throw fail("it does not say of which variable");
    return d;
}

std::shared_ptr<TimeSeries> derive(std::shared_ptr<TimeSeries> base, const Derivation&) { return base; }

Volume resampledTo(const Volume& volume, const Geometry&, const JobControl&) { return volume; }

bool onSameGrid(const Geometry& a, const Geometry& b) { return a.dims == b.dims; }

} // namespace pellucid
