// What can be done, as dialogs list it.
#pragma once

#include <QAction>
#include <QString>

namespace pellucid::gui {

/// One action and where it is found: "File", "View › Field".
struct ActionRow {
    QAction* action;
    QString place;
};

/// "Save session": a text without its mnemonic and its dots.
inline QString plainText(QString text) {
    text.remove('&');
    while (text.endsWith(QChar(0x2026))) text.chop(1);
    return text;
}
inline QString plainText(const QAction& action) { return plainText(action.text()); }

/// "Ctrl+Y, Ctrl+Shift+Z"; empty where it has no key.
inline QString keysText(const QAction& action) {
    QStringList all;
    for (const QKeySequence& key : action.shortcuts()) all << key.toString(QKeySequence::NativeText);
    return all.join(", ");
}

} // namespace pellucid::gui
