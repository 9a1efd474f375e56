// pellucid: the window.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <vector>

#include <QApplication>
#include <QCommandLineParser>
#include <QIcon>
#include <QUrl>

#include "controllers/controllers.h"
#include "controllers/menu_actions.h"
#include "runner/study_window.h"
#include "tf/formats/tf_file.h"
#include "version.h"
#include "widgets/input_habits.h"
#include "widgets/preferences.h"
#include "widgets/theme.h"
#include "window/main_window.h"

namespace {

using namespace pellucid;
using namespace pellucid::gui;

constexpr int kFailed = 1, kUsage = 2; // as the command line promises

int complain(const QString& message, int status) {
    std::fprintf(stderr, "pellucid: error: %s\n", qPrintable(message));
    return status;
}

// Qt ends the process with an abort where it finds no display; better to say so before.
bool displayMissing() {
#ifdef Q_OS_LINUX
    return qEnvironmentVariableIsEmpty("DISPLAY") && qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY") &&
           qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM");
#else
    return false;
#endif
}

/// In the words of docs/man/pellucid.1; a test compares them.
void describe(QCommandLineParser& parser) {
    parser.setApplicationDescription(
        "Shows volumes, measures what catches the eye in them, and finds transfer functions.\n"
        "Without a FILE it opens on the built-in volume sample:knee.");
    parser.addPositionalArgument(
        "FILE",
        "a volume, or the frames of a series: files, a folder, a pattern (\"f%02d.mhd\", \"f*.mhd\"); sessions and "
        "samples, a window each: *.pellucid.json, sample:NAME",
        "[FILE…]");
    parser.addOption(
        {"tf",
         "Transfer function: a *.tf.json file or one of another program, auto (what the data propose, the default), "
         "tents:N[:PEAK], ramp:N or preset:NAME.",
         "SPEC"});
    parser.addOption({"session",
                      "Continue with a saved session, a *.pellucid.json file or a PNG picture that carries one.",
                      "FILE"});
    parser.addOption({"windows", "Each FILE in a window of its own, not as frames of one series."});
    parser.addOption({"study", "Show the study that was prepared into a folder, and nothing else.", "DIR"});
    parser.addOption(
        {"participant", "Who takes part in the study; one who has begun goes on (default: a new one).", "ID"});
    parser.addOption({"renderer", "What draws the picture: auto, gl or cpu.", "NAME", "auto"});
    parser.addOption({"theme", "Colours of the window: dark, light or system; without it, as chosen last.", "NAME"});
    parser.addOption({"size", "Size of the window in pixels.", "WxH"});
    parser.addOption({"screenshot",
                      "Wait until picture and figures are complete, save the window as a PNG file, and quit.", "FILE"});
    parser.addHelpOption();
    parser.addVersionOption();
}

/// What each window opens: a session, a sample, or files that are the frames of a series.
QList<QStringList> documentsOf(const QStringList& names, bool windowEach) {
    QList<QStringList> documents;
    QStringList frames;
    for (const QString& name : names) {
        if (windowEach || name.startsWith("sample:") || name.endsWith(".pellucid.json", Qt::CaseInsensitive))
            documents << QStringList{name};
        else
            frames << name;
    }
    if (!frames.isEmpty()) documents << frames;
    return documents;
}

struct Options {
    Theme theme = Theme::Dark;
    ViewRenderer renderer = ViewRenderer::Auto;
    QSize size; ///< of a window; empty: as the last one was
    QString screenshot, tf;
    QString study, participant; ///< a folder; "": none
    QList<QStringList> documents;
    bool onSample = false; ///< nobody has named anything to open
};

/// Throws UsageError.
Options optionsOf(QCommandLineParser& parser) {
    if (!parser.parse(QApplication::arguments()))
        throw parser.unknownOptionNames().isEmpty()
            ? UsageError("wrong option", parser.errorText().chopped(1).toStdString(), "see pellucid --help")
            : UsageError("unknown option", "--" + parser.unknownOptionNames().front().toStdString(),
                         "see pellucid --help");
    const auto wrong = [&](const char* kind, const QString& option, const char* whatToDo) {
        return UsageError(std::string(kind) + " \"" + parser.value(option).toStdString() + "\"",
                          "--" + option.toStdString(), whatToDo);
    };
    Options o;
    o.screenshot = parser.value("screenshot");
    if (o.screenshot.isEmpty()) o.theme = keptTheme(); // a picture is the same on every machine
    if (parser.isSet("theme")) {
        const auto theme = findNamed<Theme>(parser.value("theme").toStdString());
        if (!theme) throw wrong("no theme", "theme", "use dark, light or system");
        o.theme = *theme;
    }
    const auto renderer = QStringList{"auto", "gl", "cpu"}.indexOf(parser.value("renderer")); // as ViewRenderer
    if (renderer < 0) throw wrong("no renderer", "renderer", "use auto, gl or cpu");
    o.renderer = static_cast<ViewRenderer>(renderer);
    if (parser.isSet("size")) {
        const QStringList parts = parser.value("size").split('x');
        if (parts.size() == 2) o.size = {parts[0].toInt(), parts[1].toInt()};
        if (o.size.width() < 1 || o.size.height() < 1) throw wrong("bad size", "size", "write it as 1280x800");
    }
    o.study = parser.value("study");
    o.participant = parser.value("participant");
    if (!o.participant.isEmpty() && o.study.isEmpty())
        throw UsageError("a participant of no study", o.participant.toStdString(), "give --study DIR, too");
    if (parser.isSet("study") && o.study.isEmpty())
        throw UsageError("no study is named", "--study", "name the folder that a study was prepared into");
    if (parser.isSet("study") && !parser.positionalArguments().isEmpty())
        throw UsageError("a study needs no file", parser.positionalArguments().join(" ").toStdString(), "leave it out");
    if (parser.isSet("study")) return o;
    o.tf = parser.value("tf");
    QStringList volumes;
    for (const QString& argument : parser.positionalArguments()) {
        const QString file = argument.startsWith("file:") ? QUrl(argument).toLocalFile() : argument;
        const bool isTf = isTfFile(file.toStdString());
        if (isTf && !o.tf.isEmpty())
            throw UsageError("more than one transfer function", file.toStdString(), "give one");
        if (isTf)
            o.tf = file;
        else
            volumes << file;
    }
    if (parser.isSet("session")) volumes.prepend(parser.value("session"));
    o.onSample = volumes.isEmpty();
    if (o.onSample) volumes << "sample:knee";
    o.documents = documentsOf(volumes, parser.isSet("windows"));
    if (!o.screenshot.isEmpty() && o.documents.size() > 1)
        throw UsageError("--screenshot takes one window", volumes.join(" ").toStdString(), "give one FILE");
    return o;
}

/// Once picture and figures are complete: saves the window and ends the program.
void photograph(MainWindow& window, const QString& file) {
    const auto save = [&window, file] {
        if (!window.isSettled()) return;
        // Texts have come that nothing has made room for yet.
        QApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
        QCoreApplication::exit(
            window.grab().save(file, "PNG")
                ? 0
                : complain("cannot write the picture, " + file + ", choose a folder you can write to", kFailed));
    };
    const auto fail = [](const Error& error) { QCoreApplication::exit(complain(error.what(), kFailed)); };
    QObject::connect(&window, &MainWindow::settledChanged, &window, save, Qt::QueuedConnection);
    for (const auto failed : {&OpenController::failed, &OpenController::tfFailed})
        QObject::connect(&window.controllers().opening, failed, &window, fail, Qt::QueuedConnection);
}

/// While a picture is taken nobody is asked: of several transfer functions in a file, the first one, as on the command
/// line.
QString firstPreset(const QString& tf) {
    try {
        const std::vector<std::string> names = tfNamesIn(tf.toStdString());
        if (!names.empty()) return tf + '#' + QString::fromStdString(names.front());
    } catch (const Error&) { // opening says why
    }
    return tf;
}

int showStudy(const Options& o) {
    const std::string folder = o.study.toStdString();
    openStudy(folder, o.participant.isEmpty() ? newParticipantId(folder) : o.participant.toStdString());
    return QApplication::exec();
}

int showWindows(const Options& o) {
    std::vector<std::unique_ptr<MainWindow>> windows;
    for (const QStringList& files : o.documents) {
        windows.push_back(std::make_unique<MainWindow>(o.renderer));
        MainWindow& window = *windows.back();
        if (o.screenshot.isEmpty()) window.restoreLayout();
        if (!o.size.isEmpty()) window.resize(o.size);
        window.show();
        if (o.screenshot.isEmpty()) {
            window.controllers().recovery.start();
            window.watchMemory();
            if (o.onSample) window.welcome();
            if (windows.size() == 1) window.controllers().recovery.offerWhenOpen();
        } else {
            photograph(window, o.screenshot);
        }
        window.controllers().opening.openAtStart(files, o.screenshot.isEmpty() ? o.tf : firstPreset(o.tf));
    }
    return QApplication::exec();
}

/// Qt takes "--session ID" for itself, but not "--session=FILE".
std::vector<std::string> withJoinedSession(int argc, char** argv) {
    std::vector<std::string> words;
    for (int i = 0; i < argc; ++i) {
        words.emplace_back(argv[i]);
        if ((words.back() == "--session" || words.back() == "-session") && i + 1 < argc)
            words.back() = std::string("--session=") + argv[++i];
    }
    return words;
}

} // namespace

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a limit on file sizes is an error of writing, not the end of the program
    QCoreApplication::setApplicationName("pellucid");
    QCoreApplication::setOrganizationName("pellucid");
    QCoreApplication::setApplicationVersion(kVersion);
    QCommandLineParser parser;
    describe(parser);
    const QStringList asking{"--help", "-h", "--help-all", "--version", "-v"}; // must work without a display
    if (std::any_of(argv, argv + argc, [&](const char* word) { return asking.contains(QLatin1String(word)); })) {
        const QCoreApplication application(argc, argv);
        parser.process(application);
        return 0;
    }
    if (displayMissing())
        return complain("no display, DISPLAY and WAYLAND_DISPLAY are not set, use pellucid-cli, or xvfb-run pellucid",
                        kFailed);
    std::vector<std::string> words = withJoinedSession(argc, argv);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    int count = static_cast<int>(arguments.size());
    arguments.push_back(nullptr);
    QApplication application(count, arguments.data());
    QGuiApplication::setDesktopFileName("pellucid"); // whose icon and name the window has
    QApplication::setWindowIcon(QIcon::fromTheme("pellucid"));
    InputHabits habits;
    application.installEventFilter(&habits);
    Options options;
    try {
        options = optionsOf(parser);
    } catch (const UsageError& error) {
        return complain(error.what(), kUsage);
    }
    applyTheme(application, options.theme);
    applyPreferences(keptPreferences());
    try {
        return options.study.isEmpty() ? showWindows(options) : showStudy(options);
    } catch (const UsageError& error) {
        return complain(error.what(), kUsage);
    } catch (const Error& error) {
        return complain(error.what(), kFailed);
    }
}
