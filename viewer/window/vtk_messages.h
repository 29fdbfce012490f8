#pragma once

#include <vtkLogger.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>

#include <string>

namespace lightwell {

/// Catches VTK's messages on standard error during the object's lifetime, so that library calls
/// stay silent and one exception describes the error.
class VtkMessages {
 public:
  VtkMessages()
      : window_before_(vtkOutputWindow::GetInstance()),
        verbosity_before_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(caught_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~VtkMessages() {
    vtkLogger::SetStderrVerbosity(verbosity_before_);
    vtkOutputWindow::SetInstance(window_before_);
  }
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  bool any() const { return !caught_->GetOutput().empty(); }

 private:
  vtkSmartPointer<vtkOutputWindow> window_before_;
  vtkLogger::Verbosity verbosity_before_;
  vtkSmartPointer<vtkStringOutputWindow> caught_ = vtkSmartPointer<vtkStringOutputWindow>::New();
};

}  // namespace lightwell
