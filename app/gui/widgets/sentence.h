// Texts of errors and notes as sentences.
#pragma once

#include <QRegularExpression>
#include <QString>

namespace pellucid::gui {

/// With a capital and a full stop: errors and notes of the core have neither. What does not begin with a plain word (a
/// file, a number, something in quotes) begins as it is.
inline QString asSentence(QString text) {
    static const QRegularExpression kPlainWord("^[a-z]+(?=[ ,;]|$)");
    text = text.trimmed();
    if (text.isEmpty()) return text;
    if (kPlainWord.match(text).hasMatch()) text[0] = text[0].toUpper();
    static const QString kEnds = QStringLiteral(".?!…");
    return kEnds.contains(text.back()) ? text : text + '.';
}

} // namespace pellucid::gui
