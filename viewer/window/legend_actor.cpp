#include "viewer/window/legend_actor.h"

#include <vtkActor2D.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

#include "viewer/window/legend.h"

namespace lightwell {
namespace {

constexpr double letter_size = 14.0;  // pixels, at a text scale of 1
constexpr int least_letters = 6;      // pixels; smaller ones cannot be read
constexpr double most_width = 0.36, share_of_height = 0.5;
constexpr int from_edge = 6;  // pixels

}  // namespace

LegendActor::LegendActor(double text_scale)
    : text_scale_(text_scale),
      image_(vtkSmartPointer<vtkImageData>::New()),
      actor_(vtkSmartPointer<vtkActor2D>::New()) {
  vtkNew<vtkImageMapper> mapper;
  mapper->SetInputData(image_);
  mapper->SetColorWindow(255.0);
  mapper->SetColorLevel(127.5);
  actor_->SetMapper(mapper);
  actor_->VisibilityOff();
}

LegendActor::~LegendActor() {
  if (renderer_) renderer_->RemoveObserver(observer_);
}

void LegendActor::add_to(vtkRenderer* renderer) {
  renderer_ = renderer;
  renderer->AddViewProp(actor_);
  // The size of the picture is known when it is drawn.
  vtkNew<vtkCallbackCommand> before_drawing;
  before_drawing->SetClientData(this);
  before_drawing->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const int* const size = static_cast<vtkRenderer*>(caller)->GetSize();
    static_cast<LegendActor*>(data)->fit(size[0], size[1]);
  });
  observer_ = renderer->AddObserver(vtkCommand::StartEvent, before_drawing);
}

void LegendActor::set(const std::optional<LegendContent>& content) {
  const auto is_same = [](const LegendContent& a, const LegendContent& b) {
    return a.range.low == b.range.low && a.range.high == b.range.high && a.unit == b.unit &&
           a.classes == b.classes;
  };
  if (!content && !content_) return;
  if (content && content_ && is_same(*content, *content_)) return;
  content_ = content;
  width_ = height_ = 0;
  actor_->VisibilityOff();
}

void LegendActor::fit(int width, int height) {
  if (!content_ || (width == width_ && height == height_)) return;
  width_ = width;
  height_ = height;
  const int wanted = static_cast<int>(std::lround(share_of_height * height));
  const auto draw = [&](int font) {
    return content_->classes ? draw_class_legend(font, wanted)
                             : draw_legend(content_->range, content_->unit, font, wanted);
  };
  const auto fits = [&](const LegendPicture& picture) {
    return picture.width <= most_width * width && picture.height <= height - 2 * from_edge;
  };
  int font = std::max(least_letters, static_cast<int>(std::lround(letter_size * text_scale_)));
  LegendPicture picture = draw(font);
  while (!fits(picture) && font > least_letters) picture = draw(--font);
  actor_->SetVisibility(fits(picture));
  if (!fits(picture)) return;
  image_->SetDimensions(picture.width, picture.height, 1);
  image_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto row = std::ptrdiff_t{3} * picture.width;
  auto* out = static_cast<std::uint8_t*>(image_->GetScalarPointer());
  // VTK's rows begin at the bottom.
  for (int y = picture.height - 1; y >= 0; --y, out += row) {
    std::copy_n(picture.rgb.begin() + row * y, row, out);
  }
  image_->Modified();
  actor_->SetPosition(width - picture.width - from_edge, (height - picture.height) / 2);
}

}  // namespace lightwell
