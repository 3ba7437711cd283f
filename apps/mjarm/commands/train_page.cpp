#include "apps/mjarm/commands/train_page.hpp"

#include <chrono>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "apps/mjarm/commands/train_curve.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/rl/trained_policy.hpp"
#include "mjarm/rl/training.hpp"
#include "mjarm/session/policy_player.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/view/playback.hpp"
#include "mjarm/view/recorded_run.hpp"
#include "mjarm/view/remote_window.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kFirstGoal = 1;           // no training sees these goals
constexpr std::chrono::milliseconds kLook{1000};  // between two looks at the files
constexpr render::Rgba kGoal = {0.15F, 0.70F, 0.30F, 0.6F};

/// Episodes of the newest policy in a folder, and the curves there.
class TrainingWorld {
 public:
  TrainingWorld(const Model& model, const rl::ReachOptions& task)
      : model_(model), task_(task), rest_(model), playback_(model.timestep()) {}

  void follow(const fs::path& folder) {
    const std::scoped_lock lock(mutex_);
    folder_ = folder;
  }
  void handle(const view::ViewEvent& event) { (void)playback_.handle(event); }
  [[nodiscard]] int steps_due() {
    look();
    return player_ ? playback_.steps_due() : 0;
  }
  void step() {
    const Result<bool> stepped = player_->step();
    if (!stepped || !*stepped) return begin_episode();
    trail_.add(player_->tool().p);
  }
  void fill(view::ViewFrame& frame) {
    frame.overlay = {};
    trail_.draw(frame.overlay);
    if (player_) {
      frame.overlay.spheres.push_back({.p_W = player_->goal(), .radius = 0.02, .color = kGoal});
    }
    frame.snapshot = player_ ? player_->sim().snapshot() : rest_.snapshot();
    frame.plots = plots_;
    frame.status = player_ ? text(msg::train_page_policy, policies_) : text(msg::train_page_none);
  }

 private:
  /// Once in a while: whether there is more to be drawn, or the first policy.
  void look() {
    if (Clock::now() < next_look_) return;
    next_look_ = Clock::now() + kLook;
    const fs::path folder = this->folder();
    if (const Result<render::Plot> curves = curve_plot(folder)) {
      plots_.clear();
      for (const render::PlotPanel& panel : curves->panels) {
        plots_.push_back(view::live_plot(panel));
      }
    }
    if (!player_) begin_episode();
  }
  /// With the newest policy; where there is none, with the one before.
  void begin_episode() {
    const fs::path file = folder() / rl::Training::kLast;
    std::error_code none;
    const fs::file_time_type time = fs::last_write_time(file, none);
    if (!none && (!player_ || time != time_)) load(file, time);
    trail_.clear();
    if (player_ && !player_->begin_episode()) player_.reset();
  }
  void load(const fs::path& file, fs::file_time_type time) {
    Result<rl::TrainedPolicy> newest = rl::load_policy(file);
    if (!newest) return;
    auto player = session::PolicyPlayer::create(model_, task_, std::move(newest->policy),
                                                kFirstGoal + policies_);
    if (!player) return;
    player_.emplace(std::move(*player));
    time_ = time;
    ++policies_;
  }
  [[nodiscard]] fs::path folder() {
    const std::scoped_lock lock(mutex_);
    return folder_;
  }

  const Model& model_;
  rl::ReachOptions task_;
  Sim rest_;
  view::Playback playback_;
  std::mutex mutex_;
  fs::path folder_;
  std::optional<session::PolicyPlayer> player_;
  fs::file_time_type time_ = {};
  std::uint64_t policies_ = 0;  ///< that were shown
  render::Trail trail_{{.max_points = 10000, .pen = render::Pen::down}};
  std::vector<view::LivePlot> plots_;
  Clock::time_point next_look_ = {};
};

}  // namespace

struct TrainPage::Impl {
  Impl(const Model& model, const rl::ReachOptions& task, view::RemoteWindow opened)
      : world(model, task),
        window(std::move(opened)),
        thread([this] { session::simulate_world(world, window.link(), language()); }) {}
  ~Impl() {
    window.link().closed = true;
    thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  TrainingWorld world;
  view::RemoteWindow window;
  std::thread thread;
};

TrainPage::TrainPage(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrainPage::~TrainPage() = default;

Result<std::unique_ptr<TrainPage>> TrainPage::open(const Model& model,
                                                   const rl::ReachOptions& task) {
  Result<view::RemoteWindow> window =
      view::RemoteWindow::open(model, "mjarm train reach", {.can_reset = false, .can_push = false});
  if (!window) return fail(std::move(window.error()));
  return std::unique_ptr<TrainPage>(
      new TrainPage(std::make_unique<Impl>(model, task, std::move(*window))));
}

void TrainPage::follow(const fs::path& folder) { impl_->world.follow(folder); }

}  // namespace mjarm::app
