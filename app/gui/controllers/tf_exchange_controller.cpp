#include "controllers/tf_exchange_controller.h"

#include <QApplication>
#include <QClipboard>

#include "base/atomic_file.h"
#include "controllers/open_controller.h"
#include "dialogs/ask_file.h"
#include "dialogs/ask_preset.h"
#include "dialogs/export_tf_dialog.h"
#include "dialogs/tf_parts_dialog.h"
#include "services/services.h"
#include "session/scene_data.h"
#include "session/variable_edits.h"
#include "store/edits.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_snippets.h"

namespace pellucid::gui {

TfExchangeController::TfExchangeController(Services& services, OpenController& opening, QObject* parent)
    : QObject(parent), m_services(services), m_opening(opening) {}

void addTfExchangeActions(Services& services, OpenController& opening) {
    (new TfExchangeController(services, opening, &services))->addActions();
}

void TfExchangeController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File"), [this] { return m_services.store().hasVolume(); });
    menu.separate();
    menu.add("exportTfAction", tr("E&xport transfer function…"), {},
             tr("For ParaView, 3D Slicer, Voreen, Inviwo and others; what is lost is said"),
             [this] { chooseExport(); });
    ActionMenu copies(m_services.actions(), tr("&File") + "/" + tr("Copy transfer f&unction"),
                      [this] { return m_services.store().hasVolume(); });
    for (const TfSnippet& snippet : tfSnippets()) {
        const QString name = QString::fromUtf8(snippet.name), title = QString::fromUtf8(snippet.title);
        copies.add("copyTf_" + name, title.startsWith("Python") ? tr("As %1").arg(title) : tr("For %1").arg(title), {},
                   tr("Lines of Python that draw the volume so, to be pasted there"),
                   [this, name] { copySnippet(name); });
    }
    menu.add("openTfPartsAction", tr("Open parts of a transfer function…"), {},
             tr("The colours, the opacities or the range of a file alone"), [this] { chooseParts(); },
             {.enabled = [this] { return m_services.isEditable(); }});
}

TfToWrite TfExchangeController::present(const std::string& path) const {
    return toWrite(m_services.scene().tf, m_services.scene(), path);
}

QStringList TfExchangeController::lossesOf(const TfFormat& format) const {
    QStringList losses;
    for (const std::string& loss : writtenTf(format, present({})).losses) losses << QString::fromStdString(loss);
    return losses;
}

bool TfExchangeController::exportTf(const TfFormat& format, const QString& path) {
    return m_services.store().hasVolume() && m_services.attempt(tr("Cannot export the transfer function"), [&] {
        const std::string file = path.toStdString();
        const WrittenTf written = writtenTf(format, present(file));
        writeTextAtomically(file, written.text);
        m_services.saySaved(path);
    });
}

void TfExchangeController::chooseExport() {
    const QString base = QFileInfo(QString::fromStdString(m_services.scene().volume->title)).completeBaseName();
    ExportTfDialog dialog(
        QDir(keptFolder("tfFolder", QDir::homePath())).filePath(base),
        [this](const TfFormat& format) { return lossesOf(format); }, m_services.window());
    while (dialog.exec() == QDialog::Accepted) {
        const auto [format, path] = dialog.options();
        if (path.isEmpty()) continue;
        if (!mayReplaceFile(m_services.window(), path, tr("Export transfer function"))) continue;
        keepFolderOf("tfFolder", path);
        exportTf(*format, path);
        return;
    }
}

void TfExchangeController::copySnippet(const QString& name) {
    for (const TfSnippet& snippet : tfSnippets())
        if (name == snippet.name) {
            const WrittenTf written = writtenTf(snippet, present({}));
            QApplication::clipboard()->setText(QString::fromStdString(written.text));
            for (const std::string& loss : written.losses) m_services.notices().add({QString::fromStdString(loss)});
            Q_EMIT m_services.message(tr("Copied: paste it into %1").arg(QString::fromUtf8(snippet.console)));
        }
}

void TfExchangeController::openParts(const QString& path, const TfParts& parts) {
    if (!m_services.isEditable()) return;
    m_services.attempt(tr("Cannot open the transfer function"), [&] {
        const Scene& scene = m_services.scene();
        const TransferFunction other = forScene(openTfFile(path.toStdString()), scene);
        m_opening.editData(tr("Open parts of a transfer function"),
                           [other, parts, window = scene.volume->range()](Session& session) {
                               takeTfParts(session, other, parts, window);
                           });
    });
}

void TfExchangeController::chooseParts() {
    const QString path = QFileDialog::getOpenFileName(
        m_services.window(), tr("Open parts of a transfer function"), keptFolder("tfFolder"),
        tr("Transfer functions (%1 *.json *.xml *.csv);;All files (*)").arg(tfPatterns()));
    if (path.isEmpty()) return;
    keepFolderOf("tfFolder", path);
    if (const QString one = askPreset(path, m_services.window()); !one.isEmpty()) chooseParts(one);
}

void TfExchangeController::chooseParts(const QString& path) {
    m_services.attempt(tr("Cannot open the transfer function"), [&] {
        const ReadTf read = openTfFile(path.toStdString());
        QStringList notices;
        for (const std::string& notice : openingNoticesIn(m_services.scene(), read))
            notices << QString::fromStdString(notice);
        TfPartsDialog dialog(nameOfPreset(path), {read.hasColors, read.hasOpacities, read.tf.range.has_value()},
                             notices, m_services.window());
        if (dialog.exec() == QDialog::Accepted) openParts(path, dialog.parts());
    });
}

} // namespace pellucid::gui
