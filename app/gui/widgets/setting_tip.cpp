#include "widgets/setting_tip.h"

#include <QStringList>

namespace pellucid::gui {
namespace {

constexpr int kTipWidth = 90; ///< letters

} // namespace

QString settingTip(const Setting& setting, bool isNumber, const QString& suffix, double factor) {
    QString text = QString::fromUtf8(setting.help);
    if (isNumber) {
        NumberRange range = setting.range;
        range.lo *= factor;
        if (range.hi < NumberRange::kFinite) range.hi *= factor;
        text += QString::fromStdString(" (" + range.text()) + suffix + ")";
    }
    return inTipLines(text);
}

QString inTipLines(const QString& text) {
    QString lines;
    int length = 0;
    for (const QString& word : text.split(' ')) {
        const bool breaks = length > 0 && length + word.size() > kTipWidth;
        lines += (lines.isEmpty() ? "" : breaks ? "\n" : " ") + word;
        length = (breaks ? 0 : length + 1) + static_cast<int>(word.size());
    }
    return lines;
}

} // namespace pellucid::gui
