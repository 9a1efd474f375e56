#include "view/picture_pair.h"

#include <QGridLayout>

#include "controllers/refine_controller.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/image_convert.h"
#include "widgets/layouts.h"

namespace pellucid::gui {

PicturePair::PicturePair(Services& services, RefineController& refining, QWidget* parent)
    : QDialog(parent), m_services(services), m_refining(refining), m_words(wrappedLabel("pairWords", this)),
      m_renderer(std::make_shared<KeptRenderer>()),
      m_job(
          [renderer = m_renderer](const Inputs& inputs, const JobControl& job) {
              Pictures pictures;
              for (std::size_t i = 0; i < inputs.size(); ++i)
                  pictures[i] = qImageFromImage(renderer->render(inputs[i], job));
              return pictures;
          },
          [this](const Inputs&, Pictures& pictures) {
              m_pictures = std::move(pictures);
              showPictures();
          }) {
    setObjectName("picturePair");
    setWindowTitle(tr("Before and after refinement"));
    setAttribute(Qt::WA_DeleteOnClose);
    auto* grid = inset(new QGridLayout(this), {12, 12, 12, 12});
    grid->setSpacing(8);
    const char* const names[] = {"Before", "After"};
    for (int i = 0; i < 2; ++i) {
        auto* picture = named(new QLabel(this), QStringLiteral("picture%1").arg(names[i]));
        picture->setAlignment(Qt::AlignCenter);
        picture->setMinimumSize(200, 150);
        picture->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Ignored); // it must not follow what it shows
        picture->setAutoFillBackground(true);
        picture->setBackgroundRole(QPalette::Base);
        auto* caption = named(new QLabel(this), QStringLiteral("caption%1").arg(names[i]),
                              tr("Energy: variance of the edge weights, summed over the edges with a movable end"));
        caption->setAlignment(Qt::AlignCenter);
        m_labels[static_cast<std::size_t>(i)] = picture;
        m_captions[static_cast<std::size_t>(i)] = caption;
        grid->addWidget(picture, 0, i);
        grid->addWidget(caption, 1, i);
        grid->setColumnStretch(i, 1);
    }
    grid->setRowStretch(0, 1);
    m_words->setAlignment(Qt::AlignCenter);
    grid->addWidget(m_words, 2, 0, 1, 2);
    resize(1000, 520);

    const auto again = [this] { m_wait.start(); };
    connect(&services.store(), &SessionStore::changed, this, [this, again](const Scene& before, const Scene& after) {
        if (before.volume != after.volume) m_renderer->release();
        again();
    });
    connect(&refining, &RefineController::refined, this, again);
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_words->setText(tr("The pictures could not be drawn: %1").arg(error.what()));
    });
    m_wait.start();
}

void PicturePair::start() {
    const Refinement* refinement = m_refining.latest();
    if (refinement == nullptr) return static_cast<void>(close()); // of a volume that has gone
    const QSize pixels = (m_labels[0]->size() * devicePixelRatioF()).expandedTo({1, 1});
    const auto inputOf = [&](const TransferFunction& tf) {
        Scene scene = m_services.scene();
        scene.tf = tf;
        return pictureInput(scene, pixels.width(), pixels.height());
    };
    Inputs inputs{inputOf(refinement->before), inputOf(refinement->after)};
    const auto energy = [](double value) { return QString::number(value, 'g', 3).replace('-', QChar(0x2212)); };
    m_captions[0]->setText(tr("Before: energy %1").arg(energy(refinement->result.energyMovableBefore)));
    m_captions[1]->setText(tr("After: energy %1").arg(energy(refinement->result.energyMovableAfter)));
    m_words->setText(refinement->words);
    if (m_pictures[0].isNull())
        for (QLabel* label : m_labels) label->setText(tr("Being drawn…"));
    m_job.start(std::move(inputs), tr("the pictures"));
}

void PicturePair::showPictures() {
    for (std::size_t i = 0; i < m_pictures.size(); ++i) {
        QPixmap pixmap = QPixmap::fromImage(m_pictures[i]);
        pixmap.setDevicePixelRatio(devicePixelRatioF());
        m_labels[i]->setPixmap(pixmap);
    }
}

void PicturePair::resizeEvent(QResizeEvent* event) {
    QDialog::resizeEvent(event);
    m_wait.start();
}

} // namespace pellucid::gui
