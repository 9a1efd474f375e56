// The variables of a session: what they are, what they drive, and the ground under them.
#pragma once

#include <map>
#include <string>

#include <QWidget>

#include "jobs/job.h"
#include "session/variable_edits.h"
#include "store/session_store.h"

class QLabel;
class QLineEdit;
class QMenu;
class QPushButton;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace pellucid::gui {

class ChannelsBox;
class OpenController;
class Services;

/// What is known of a variable once its present frame has been read.
struct VariableInfo {
    Int3 dims{0, 0, 0};
    int frames = 1;
    ValueRange range;                ///< data units
    bool wholeRange = false;         ///< of all frames, not of the present one alone
    bool sameGrid = true;            ///< as the first variable
    std::vector<std::string> arrays; ///< of its file, where that has several
    std::string problem;             ///< why it cannot be read; empty: it can
};

class VariablesPanel : public QWidget {
    Q_OBJECT
public:
    VariablesPanel(Services& services, OpenController& opening, QWidget* parent = nullptr);

    QSize sizeHint() const override; ///< without scrolling
    std::string selected() const;    ///< name of the variable in the list; empty: none
    ChannelsBox& channels() { return *m_channels; }

private:
    QWidget* makeList();
    void fillAddMenu();
    void follow();
    void lookAtVariables();
    void showRange();
    void add(const Variable& variable, const QString& text);
    void addFrom(const VolumeSource& source);
    void rename(QTreeWidgetItem* item);
    void remove();
    void editRange();

    Services& m_services;
    OpenController& m_opening;
    QTreeWidget* m_list;
    ChannelsBox* m_channels;
    QToolButton* m_add;
    QMenu* m_addMenu;
    QPushButton *m_remove, *m_wholeRange;
    QLineEdit *m_lo, *m_hi;
    QLabel* m_notice;
    std::map<std::string, VariableInfo> m_infos;
    bool m_showing = false; ///< the controls show, they do not edit
    Job<Scene, std::map<std::string, VariableInfo>> m_looking;
};

} // namespace pellucid::gui
