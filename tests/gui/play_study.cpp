#include "play_study.h"

#include <QApplication>
#include <QPushButton>
#include <QTest>
#include <QTimer>

#include "runner/study_window.h"

namespace pellucid::gui {

int playStudy(const std::string& folder, const std::string& participant) {
    StudyWindow* window = openStudy(folder, participant);
    QTimer hand;
    QObject::connect(&hand, &QTimer::timeout, window, [window] {
        if (window->page() == StudyWindow::Page::Question) {
            const Participation& person = window->participation();
            const int score = scoreOf(person.stimulusOf(person.next()));
            return QTest::keyClick(window, static_cast<Qt::Key>(Qt::Key_0 + score));
        }
        for (const char* id : {"consentAgree", "visionNormal", "studyStart", "studyGoOn", "studyClose"})
            if (auto* button = window->findChild<QPushButton*>(id); button->isVisible() && button->isEnabled())
                return button->click();
    });
    hand.start(5);
    return QApplication::exec();
}

} // namespace pellucid::gui
