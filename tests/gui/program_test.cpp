// The program itself, as it is started from a shell.
#include "gui_support.h"

#include <fstream>

#include <QProcess>
#include <QTemporaryDir>

using namespace pellucid::gui;

namespace {

struct Run {
    int status = -1;
    QString out, err;
};

Run start(const QStringList& arguments, bool display = true) {
    const QTemporaryDir settings;
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert("XDG_CONFIG_HOME", settings.path());
    if (!display) {
        for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) environment.remove(name);
    }
    process.setProcessEnvironment(environment);
    process.start(PELLUCID_PROGRAM, arguments);
    REQUIRE(process.waitForFinished(kPatience));
    REQUIRE(process.exitStatus() == QProcess::NormalExit);
    return {process.exitCode(), QString::fromUtf8(process.readAllStandardOutput()),
            QString::fromUtf8(process.readAllStandardError())};
}

} // namespace

TEST_CASE("a screenshot shows the window with picture and figures", "[program]") {
    const QTemporaryDir folder;
    const QString path = folder.filePath("window.png");
    const Run run = start({"sample:disks", "--tf", "tents:2", "--size", "1000x700", "--screenshot", path});
    INFO(run.err.toStdString());
    REQUIRE(run.status == 0);
    const QImage image(path);
    CHECK(image.height() == 700);
    CHECK(image.width() >= 1000); // or the least that the docks need
    QSet<QRgb> colors;
    for (int x = 0; x < image.width() / 2; x += 2) {
        for (int y = 100; y < image.height() / 2; y += 2) colors.insert(image.pixel(x, y));
    }
    CHECK(colors.size() > 10); // the view, in the upper left part, is not empty
}

TEST_CASE("help and version need no display, a window does", "[program]") {
    const Run help = start({"--help"}, false);
    CHECK(help.status == 0);
    CHECK(help.out.contains("--screenshot"));
    CHECK(start({"--version"}, false).out.startsWith("pellucid "));
    const Run window = start({}, false);
    CHECK(window.status == 1);
    CHECK(window.err.startsWith("pellucid: error: no display"));
    CHECK(window.err.count('\n') == 1);
}

TEST_CASE("wrong usage is told in one line, with status 2", "[program]") {
    for (const QStringList& arguments :
         {QStringList{"--nonsense"}, {"--size", "12"}, {"--renderer", "pencil"}, {"a.tf.json", "b.tf.json"}}) {
        const Run run = start(arguments);
        INFO(arguments.join(' ').toStdString() << ": " << run.err.toStdString());
        CHECK(run.status == 2);
        CHECK(run.err.contains("pellucid: error: "));
    }
}

TEST_CASE("a volume that cannot be opened ends a screenshot with status 1", "[program]") {
    const QTemporaryDir folder;
    const Run run = start({"/nonexistent/a.nrrd", "--screenshot", folder.filePath("a.png")});
    CHECK(run.status == 1);
    CHECK_FALSE(QFile::exists(folder.filePath("a.png")));
}
