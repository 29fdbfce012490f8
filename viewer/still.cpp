#include "viewer/still.h"

#include <vtkActor2D.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "raytrace/render.h"
#include "scene/errors.h"
#include "viewer/appearance.h"

namespace lightwell {
namespace {

constexpr double fade_seconds = 0.4;

// What render() reads of a solution; channels may be many times as large.
SolvedScene for_rendering(const SolvedScene& solved) {
  SolvedScene copy;
  copy.mesh = solved.mesh;
  const RadiositySolution& s = solved.solution;
  copy.solution.bands = s.bands;
  copy.solution.patch_radiosity = s.patch_radiosity;
  copy.solution.direct_irradiance = s.direct_irradiance;
  copy.solution.indirect_irradiance = s.indirect_irradiance;
  copy.solution.caustic_irradiance = s.caustic_irradiance;
  return copy;
}

}  // namespace

struct Still::Job {
  Job(const Scene& scene, const SolvedScene& of, const Camera& camera, double with_scale)
      : solved(for_rendering(of)),
        scale(with_scale),
        thread([this, &scene, camera] { run(scene, camera); }) {}
  ~Job() {
    cancelled = true;
    thread.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void run(const Scene& scene, const Camera& camera) {
    try {
      const ElementCaster caster(solved.mesh);
      const DirectLight direct_light(scene, solved.mesh);
      RenderOptions options;
      options.progress = [this](std::string_view, double share) {
        progress = share;
        return !cancelled;
      };
      image = render(scene, caster, direct_light, solved.solution, camera, options);
      picture = display_colors(image.radiance, solved.solution.bands, scale);
    } catch (const Interrupted&) {
      // Nobody waits for it.
    } catch (const std::exception& error) {
      failure = error.what();
    }
    done = true;
  }

  SolvedScene solved;
  double scale;
  Image image{};
  std::vector<std::uint8_t> picture{};
  std::string failure{};
  std::atomic<double> progress{0.0};
  std::atomic<bool> cancelled{false}, done{false};
  std::thread thread;  // last: it uses the others
};

Still::Still()
    : data_(vtkSmartPointer<vtkImageData>::New()), actor_(vtkSmartPointer<vtkActor2D>::New()) {
  vtkNew<vtkImageMapper> mapper;
  mapper->SetInputData(data_);
  mapper->SetColorWindow(255.0);
  mapper->SetColorLevel(127.5);
  actor_->SetMapper(mapper);
  actor_->VisibilityOff();
}

Still::~Still() = default;

void Still::add_to(vtkRenderer* renderer) const {
  renderer->AddViewProp(actor_);
}

void Still::begin(const Scene& scene, const SolvedScene& solved, const Camera& camera,
                  double scale) {
  discard();
  camera_ = camera;
  phase_ = StillPhase::rendering;
  job_ = std::make_unique<Job>(scene, solved, camera, scale);
}

void Still::discard() {
  std::erase_if(ending_, [](const std::unique_ptr<Job>& job) { return job->done.load(); });
  if (job_) {
    job_->cancelled = true;
    ending_.push_back(std::move(job_));
  }
  phase_ = StillPhase::none;
  actor_->VisibilityOff();
}

double Still::progress() const {
  return job_ ? job_->progress.load() : 0.0;
}

bool Still::arrived() {
  if (phase_ != StillPhase::rendering || !job_->done) return false;
  if (!job_->failure.empty()) {
    failure_ = job_->failure;
    discard();
    phase_ = StillPhase::failed;
    return false;
  }
  image_ = std::move(job_->image);
  picture_ = std::move(job_->picture);
  job_.reset();
  return true;
}

void Still::show_over(std::vector<std::uint8_t> under) {
  under_ = std::move(under);
  phase_ = StillPhase::shown;
  shown_seconds_ = 0.0;
  data_->SetDimensions(image_.width, image_.height, 1);
  data_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  // Without anything to fade from it is there at once.
  if (under_.size() != picture_.size()) shown_seconds_ = fade_seconds;
  draw(shown_seconds_ / fade_seconds);
  actor_->VisibilityOn();
}

bool Still::fade(double seconds) {
  if (phase_ != StillPhase::shown || shown_seconds_ >= fade_seconds) return false;
  shown_seconds_ += seconds;
  draw(std::min(shown_seconds_ / fade_seconds, 1.0));
  return true;
}

// VTK's rows begin at the bottom.
void Still::draw(double share) {
  auto* out = static_cast<std::uint8_t*>(data_->GetScalarPointer());
  const auto row = std::size_t{3} * static_cast<std::size_t>(image_.width);
  const int weight = static_cast<int>(256.0 * share);
  for (int y = 0; y < image_.height; ++y) {
    const std::uint8_t* from = picture_.data() + row * static_cast<std::size_t>(y);
    const std::size_t at = row * static_cast<std::size_t>(image_.height - 1 - y);
    for (std::size_t i = 0; i < row; ++i) {
      const int below = weight < 256 ? under_[at + i] : 0;
      out[at + i] = static_cast<std::uint8_t>((weight * from[i] + (256 - weight) * below) / 256);
    }
  }
  data_->Modified();
}

}  // namespace lightwell
