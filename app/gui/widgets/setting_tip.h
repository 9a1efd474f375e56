// Tool tips of settings: what they do, with their range and unit.
#pragma once

#include <QString>

#include "base/setting.h"

namespace pellucid::gui {

/// The setting's help in lines; of a number with the numbers that are allowed. `factor`: from the setting to what is
/// shown. `suffix`: what stands behind the number, with its blank.
QString settingTip(const Setting& setting, bool isNumber, const QString& suffix, double factor = 1);

/// The same words in lines that are as long as a tool tip's.
QString inTipLines(const QString& text);

} // namespace pellucid::gui
