#include "foreign/arrays/array_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace pellucid {

const ArrayVariable* ArrayFile::find(const std::string& name) const {
    const auto found = std::ranges::find(variables(), name, &ArrayVariable::name);
    return found == variables().end() ? nullptr : &*found;
}

std::optional<double> ArrayFile::number(const ArrayVariable& variable, const std::string& name) const {
    const auto found = attribute(variable, name);
    if (!found || found->numbers.empty()) return {};
    return found->numbers.front();
}

std::string ArrayFile::text(const ArrayVariable& variable, const std::string& name) const {
    const auto found = attribute(variable, name);
    return found ? found->text : "";
}

std::vector<double> ArrayFile::values(const ArrayVariable& variable) const {
    std::vector<double> values(valuesIn(variable));
    const double slope = number(variable, "scale_factor").value_or(1);
    const double intercept = number(variable, "add_offset").value_or(0);
    withType(variable.type.value(), [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> stored(values.size());
        read(variable, {std::vector<std::int64_t>(variable.dims.size(), 0), variable.dims},
             std::as_writable_bytes(std::span(stored)));
        std::ranges::transform(stored, values.begin(),
                               [&](T value) { return slope * static_cast<double>(value) + intercept; });
    });
    return values;
}

std::string nameOf(ValueType type) {
    return std::array{
        "u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64"}[static_cast<std::size_t>(type)];
}

bool isRun(const ArrayVariable& variable, const ArrayBox& box) {
    bool areSeveral = false; // an axis before this one has more than one place
    for (std::size_t a = 0; a < variable.dims.size(); ++a) {
        if (areSeveral && box.size[a] != variable.dims[a]) return false;
        areSeveral |= box.size[a] > 1;
    }
    return true;
}

std::uint64_t valuesIn(const ArrayVariable& variable) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max() / 8;
    std::uint64_t count = 1;
    for (const std::int64_t size : variable.dims) {
        if (size < 1 || count > kMost / static_cast<std::uint64_t>(size)) return 0;
        count *= static_cast<std::uint64_t>(size);
    }
    return count;
}

} // namespace pellucid
