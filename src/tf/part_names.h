// Names of features that are cut in two by value, and of two parts that become one again.
#pragma once

#include <string>
#include <utility>

namespace pellucid {

/// The lower and the upper part of the feature `name`, cut at the value `border`: "bone up to 700" and "bone from 700",
/// and from that "bone from 700 to 900" and "bone from 900"; a name that is an interval alone, "20 to 80", gives
/// "20 to 45" and "45 to 80". `border` is a number as text, in the units of the values.
std::pair<std::string, std::string> namesOfParts(const std::string& name, const std::string& border);

/// The name of two neighbours as one feature: where they are parts of one, what that was called before; else both.
std::string nameOfWhole(const std::string& lower, const std::string& upper);

} // namespace pellucid
