// Web pages from the window: what the dialog offers and asks, and what comes of it.
#include "gui_support.h"

#include <cmath>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFile>
#include <QLineEdit>
#include <QPushButton>
#include <QTemporaryDir>
#include <QTimer>

#include "dialogs/share_dialog.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Answers the dialog once it is open.
void withDialog(const std::function<void(ShareDialog&)>& answer) {
    QTimer::singleShot(0, [answer] {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (auto* dialog = qobject_cast<ShareDialog*>(widget)) return answer(*dialog);
    });
}

QPushButton& saveOf(QDialog& dialog) { return *dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save); }

} // namespace

TEST_CASE("the page's dialog offers sizes with their megabytes, and asks whether the voxels may be shared", "[share]") {
    // 512³ voxels, a byte each: factors 1, 2, 4 and 8 keep to the sizes.
    const auto estimate = [](const ShareSettings& s) {
        int factor = 1;
        while (512 / factor > std::cbrt(s.voxels) + 0.5) factor *= 2;
        const int n = 512 / factor;
        return ShareEstimate{{n, n, n}, factor, 8, 1.0 * n * n * n};
    };
    ShareOptions offered;
    offered.settings.title = "Volume";
    offered.path = "page.html";
    ShareDialog dialog(offered, estimate);
    const auto& size = *dialog.findChild<QComboBox*>("shareSize");
    REQUIRE(size.count() == 4);
    CHECK(size.itemText(0).contains("512 × 512 × 512"));
    CHECK(size.itemText(0).contains("134.2 MB"));
    CHECK(size.currentText().contains("Coarser by 2")); // 16 million voxels
    CHECK(dialog.options().settings.voxels == ShareSettings{}.voxels);
    CHECK_FALSE(saveOf(dialog).isEnabled());
    dialog.findChild<QCheckBox*>("shareAllowed")->setChecked(true);
    CHECK(saveOf(dialog).isEnabled());
    dialog.findChild<QLineEdit*>("sharePath")->setText(" ");
    CHECK_FALSE(saveOf(dialog).isEnabled());
    dialog.findChild<QLineEdit*>("sharePath")->setText("skull");
    CHECK(dialog.options().path == "skull.html");
    CHECK(dialog.options().settings.title.empty());
    dialog.findChild<QLineEdit*>("shareTitle")->setText("Skull");
    dialog.findChild<QCheckBox*>("shareDensity")->setChecked(false);
    dialog.findChild<QComboBox*>("shareBits")->setCurrentIndex(2);
    CHECK(dialog.options().settings ==
          ShareSettings{.bits = ShareBits::Sixteen, .title = "Skull", .density = ShareDensity::Off});
    CHECK(size.currentText().contains("Coarser by 2")); // it has not changed with the bits
}

TEST_CASE("a page of the window is written in the background, and can be opened", "[share]") {
    const QTemporaryDir folder;
    OpenWindow w(16);
    ShareController& sharing = w.controllers().sharing;
    QSignalSpy saved(&sharing, &ShareController::saved);
    const QString path = folder.filePath("page.html");
    withDialog([path](ShareDialog& dialog) {
        dialog.findChild<QLineEdit*>("shareTitle")->setText("Seen <here>");
        dialog.findChild<QLineEdit*>("sharePath")->setText(path);
        dialog.findChild<QCheckBox*>("shareAllowed")->setChecked(true);
        dialog.accept();
    });
    w.child<QAction>("shareAction").trigger();
    CHECK(sharing.isBusy());
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    QFile file(path);
    REQUIRE(file.open(QIODevice::ReadOnly));
    CHECK(file.readAll().contains("<h1>Seen &#60;here&#62;</h1>"));
    const std::vector<Notice>& notices = w.services().notices().all();
    const auto notice =
        std::find_if(notices.begin(), notices.end(), [](const Notice& n) { return n.text.startsWith("page.html"); });
    REQUIRE(notice != notices.end());
    REQUIRE(notice->choices.size() == 1);
    CHECK(notice->choices[0].text == "Open in browser");
    CHECK(w.document().stepCount() == 0);
}
