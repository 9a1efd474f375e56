// *.tfi, the transfer functions of Voreen, in which the thesis's own are published: keys over a domain, colours of
// 8 bits.
#pragma once

#include <string>
#include <string_view>

#include "tf/transfer_function.h"

namespace pellucid {

/// What the file draws, as control points:
/// - a key is a point, a split key two that share an x; between keys colour and opacity are linear, and beyond the
///   outer ones they are held;
/// - outside the threshold the opacity is 0; alpha modes 0 and 2 make it 0 and 1 everywhere within;
/// - a gamma γ other than 1 looks up s^γ: 16 chords from key to key stand for it;
/// - a domain other than 0..1 is the range, in data units; features are derived (deriveFeatures()), and points of
///   opacity 0 are fixed, as the bottoms of tents are.
/// Elements that older files lack may be absent, others are ignored. Throws FileError naming line and key: no XML, no
/// transfer function in it, a number that is missing, none, not finite or out of range, more than 4096 keys.
TransferFunction tfFromVoreen(std::string_view text, const std::string& path);
TransferFunction readVoreenTf(const std::string& path);

} // namespace pellucid
