// What a study says and asks, for how long, and of which stimuli.
#pragma once

#include <functional>
#include <vector>

#include <QDialog>

#include "study/study.h"

class QLineEdit;
class QSpinBox;
class QTableWidget;
class QWidget;

namespace pellucid::gui {

class StudyDialog : public QDialog {
    Q_OBJECT
public:
    explicit StudyDialog(Study study, QWidget* parent = nullptr);
    Study study() const; ///< as it has been edited

private:
    QWidget* controlOf(const Setting& setting);
    QWidget* makeStimuli();
    void fillStimuli();
    void moveStimulus(int by);
    void removeStimulus();

    Study m_study; ///< what the controls do not say
    std::vector<std::function<void(Study&)>> m_take;
    QSpinBox *m_width, *m_height;
    std::vector<QLineEdit*> m_labels; ///< of the scores in their order
    QTableWidget* m_stimuli;
};

} // namespace pellucid::gui
