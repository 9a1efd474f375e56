// How much of the answer of an optimization can be seen, in words.
#pragma once

#include <string>
#include <vector>

#include "optimize/optimizer.h"

namespace pellucid {

/// One sentence, where the answer keeps the picture visible instead of the shares that were asked for: what was asked,
/// what was kept, and what the picture would be otherwise. Empty elsewhere.
std::string keptText(const OptimizeResult& result);

/// What of the answer cannot be seen, and which shares would show it; empty where it can be.
std::string faintText(const OptimizeResult& result);

/// "a, b and c"
std::string listed(const std::vector<std::string>& words);

/// "12 %"; below 10 % "1.2 %", below 0.1 % "< 0.1 %".
std::string percentText(double share);

/// Of the distance F of shares from their targets: "off target by 2.2 %".
std::string offTargetText(double objective);

} // namespace pellucid
