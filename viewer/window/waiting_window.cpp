#include "viewer/window/waiting_window.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "viewer/window/vtk_messages.h"
#include "viewer/window/x_display.h"

namespace lightwell {
namespace {

constexpr std::chrono::milliseconds between_looks{20};

/// State that the callbacks of a waiting window share.
struct Waiting {
  vtkRenderWindowInteractor* interactor;
  bool is_closed = false;
};

void take_event(vtkObject*, unsigned long event, void* data, void*) {
  auto& waiting = *static_cast<Waiting*>(data);
  const char* const key = waiting.interactor->GetKeySym();
  const bool is_escape = key && std::string(key) == "Escape";
  if (event == vtkCommand::ExitEvent || is_escape) waiting.is_closed = true;
}

}  // namespace

WaitingWindow::WaitingWindow(const std::string& title, int width, int height, double text_scale)
    : opened_{vtkSmartPointer<vtkRenderWindow>::New(),
              vtkSmartPointer<vtkRenderWindowInteractor>::New()},
      renderer_(vtkSmartPointer<vtkRenderer>::New()),
      overlay_(text_scale) {
  overlay_.add_to(renderer_);
  opened_.window->SetWindowName(title.c_str());
  opened_.window->SetSize(std::max(1, width), std::max(1, height));
  opened_.window->SetMultiSamples(0);
  opened_.window->AddRenderer(renderer_);
  opened_.interactor->SetRenderWindow(opened_.window);
  opened_.interactor->SetInteractorStyle(nullptr);
}

WaitingWindow::~WaitingWindow() = default;

// Events are taken without the interactor's own loop, which cannot be begun again for the next
// picture after it has ended.
bool WaitingWindow::run(const std::function<std::optional<std::string>()>& status) {
  const VtkMessages messages;
  vtkRenderWindowInteractor* const interactor = opened_.interactor;
  Waiting waiting{.interactor = interactor};
  vtkNew<vtkCallbackCommand> events;
  events->SetClientData(&waiting);
  events->SetCallback(&take_event);
  interactor->AddObserver(vtkCommand::ExitEvent, events);
  interactor->AddObserver(vtkCommand::KeyPressEvent, events);
  std::string shown;
  for (auto text = status(); text && !waiting.is_closed; text = status()) {
    if (*text != shown) {
      shown = *text;
      overlay_.set_status(shown, std::max(1, opened_.window->GetSize()[0]));
      opened_.window->Render();
    }
    interactor->Initialize();
    std::this_thread::sleep_for(between_looks);
    interactor->ProcessEvents();
  }
  interactor->RemoveObserver(events);
  opened_.window->RemoveRenderer(renderer_);
  if (waiting.is_closed) {
    hide_window(opened_.window->GetGenericDisplayId(), opened_.window->GetGenericWindowId());
  }
  return !waiting.is_closed;
}

}  // namespace lightwell
