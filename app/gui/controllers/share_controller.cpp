#include "controllers/share_controller.h"

#include <map>

#include <QDesktopServices>
#include <QDir>
#include <QFileInfo>
#include <QUrl>

#include "dialogs/ask_file.h"
#include "dialogs/share_dialog.h"
#include "services/services.h"
#include "share/share.h"

namespace pellucid::gui {
namespace {

constexpr int kAnySize = 16; // a page has the size of its window

} // namespace

ShareController::ShareController(Services& services)
    : FileWork(&makeShare, [this](const ShareTask& task, const SharedPage& page) { tell(task, page); }),
      m_services(services) {
    services.showFailuresOf(job(), tr("Cannot write the page"));
}

ShareController::~ShareController() = default;

void ShareController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File"), [this] { return m_services.store().hasVolume(); });
    menu.add("shareAction", tr("Share as &web page…"), {},
             tr("One HTML file with the volume, which can be turned in a browser, without a network"),
             [this] { choose(); });
}

void ShareController::tell(const ShareTask& task, const SharedPage& page) {
    const QString path = QString::fromStdString(task.path);
    m_services.saySaved(path, tr("%L1 MB").arg(static_cast<double>(page.bytes) / 1e6, 0, 'f', 1));
    QString text = tr("%1 is written.").arg(QFileInfo(path).fileName());
    for (const std::string& left : page.leftOut) text += QStringLiteral("\n") + QString::fromStdString(left);
    m_services.notices().add(
        {text, {{tr("Open in browser"), [path] { QDesktopServices::openUrl(QUrl::fromLocalFile(path)); }}}});
    Q_EMIT saved(path);
}

void ShareController::choose() {
    const Scene scene = m_services.scene(); // the page is of what is seen now, however long the dialog is open
    ShareTask task{scene, pictureInput(scene, kAnySize, kAnySize).settings};
    if (!m_services.attempt(tr("Cannot write the page"), [&] { checkShare(task); })) return;
    ShareOptions offered;
    offered.settings.title = proposedTitle(scene);
    offered.path = QDir(keptFolder("shareFolder", QDir::homePath()))
                       .filePath(QString::fromStdString(offered.settings.title) + ".html");
    std::map<ShareBits, double> perVoxel; // once of each: it compresses
    const auto estimate = [&](const ShareSettings& settings) {
        const auto known = perVoxel.find(settings.bits);
        const double bytes = known != perVoxel.end() ? known->second : pageBytesPerVoxel(scene, settings.bits);
        perVoxel[settings.bits] = bytes;
        return estimateShare(scene, settings, bytes);
    };
    ShareDialog dialog(offered, estimate, m_services.window());
    while (dialog.exec() == QDialog::Accepted) {
        const ShareOptions chosen = dialog.options();
        if (!mayReplaceFile(m_services.window(), chosen.path, tr("Share as web page"))) continue;
        keepFolderOf("shareFolder", chosen.path);
        task.settings = chosen.settings;
        task.path = chosen.path.toStdString();
        start(task);
        return;
    }
}

} // namespace pellucid::gui
