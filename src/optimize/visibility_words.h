// Shares that can be met and not be seen, in words.
#pragma once

#include <string>

#include "optimize/optimizer.h"

namespace pellucid {

/// Two sentences, the first without a capital: what is faint and why; which shares would be visible. `strongest`: the
/// coverage of the strongest picture with the present shares.
std::string faintText(const TransferFunction& tf, const Faintness& faint, double strongest);

/// The same of an answer; empty where it is not faint.
std::string faintText(const OptimizeResult& result);

/// "12 %"; below 10 % "1.2 %", below 0.1 % "< 0.1 %".
std::string percentText(double share);

} // namespace pellucid
