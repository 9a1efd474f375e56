// What attributes say of how values are packed, and which of them are none (NetCDF User Guide, "Attribute Conventions";
// CF Conventions 1.10, sections 2.5 and 8.1).
#pragma once

#include "foreign/arrays/array_file.h"

namespace pellucid {

struct PackedValues {
    ValueType type = ValueType::U8;      ///< in which they are written
    std::optional<ValueScaling> scaling; ///< from what is written to what is meant
    std::vector<double> missing;         ///< what stands for none, as it is written
    std::optional<ValueRange> valid;     ///< as they are written; others are none
    std::optional<double> mark;          ///< all that are none become this; empty: NaN, or there are none
    std::vector<std::string> notices;
};

PackedValues packedValuesOf(const ArrayFile& file, const ArrayVariable& variable);

/// Writes `mark` over all values that are none.
void markMissing(const PackedValues& packed, std::span<std::byte> values);

/// Whether markMissing() leaves all values as they are.
bool areMarked(const PackedValues& packed);

/// What the mark becomes where values are unpacked to `kept`.
std::optional<double> missingAs(SampleType kept, const PackedValues& packed);

} // namespace pellucid
