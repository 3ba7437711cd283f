#include "mjarm/sim/batch.hpp"

#include <mujoco/mjbatch.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <numeric>
#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/sim.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/sim/raw_internal.hpp"

namespace mjarm {
namespace {

constexpr int kMaxWorlds = 100000;
constexpr int kMaxThreads = 1024;

struct DeleteBatch {
  void operator()(mjBatch* batch) const { mjb_deleteBatch(batch); }
};

/// What a geom belongs to, when contacts are counted.
enum class Part : std::uint8_t { surroundings, arm, finger };

std::vector<Part> parts_of(const mjModel& m, const Arm& arm) {
  std::vector<Part> of_body(static_cast<std::size_t>(m.nbody), Part::surroundings);
  of_body[m.dof_bodyid[arm.joints.front().dof]] = Part::arm;
  if (arm.gripper) {
    for (const std::string& finger : arm.gripper->joints) {
      const int joint = mj_name2id(&m, mjOBJ_JOINT, finger.c_str());
      if (joint >= 0) of_body[m.jnt_bodyid[joint]] = Part::finger;
    }
  }
  for (int body = 1; body < m.nbody; ++body) {  // parents come first
    if (of_body[body] != Part::finger) {
      of_body[body] = std::max(of_body[body], of_body[m.body_parentid[body]]);
    }
  }
  std::vector<Part> of_geom(static_cast<std::size_t>(m.ngeom));
  for (int geom = 0; geom < m.ngeom; ++geom) of_geom[geom] = of_body[m.geom_bodyid[geom]];
  return of_geom;
}

/// What `count_contacts` reads and writes. Other threads begin with `take` and end with `give`:
/// MuJoCo's own locks order the same, but a thread sanitizer does not see into its library.
struct ContactCount {
  const mjModel& m;
  const Arm& arm;
  const std::vector<Part>& part_of_geom;
  std::vector<int>& contacts;
  std::atomic<int> handed_over = 0;

  void give() noexcept { handed_over.fetch_add(1, std::memory_order_release); }
  void take() const noexcept { (void)handed_over.load(std::memory_order_acquire); }
};

int contacts_that_count(const mjData& d, const ContactCount& rules) {
  int count = 0;
  for (int i = 0; i < d.ncon; ++i) {
    const mjContact& contact = d.contact[i];
    if (contact.exclude != 0 || contact.dist > contact.includemargin) continue;
    const auto part = [&](int side) {
      return contact.geom[side] >= 0 ? rules.part_of_geom[contact.geom[side]] : Part::surroundings;
    };
    const auto geom = [&](int side) {
      const int id = contact.geom[side];
      return ModelGeom{id, id >= 0 ? rules.m.geom_bodyid[id] : -1};
    };
    const bool fingers = part(0) == Part::finger && part(1) == Part::finger;
    const bool arm = part(0) != Part::surroundings || part(1) != Part::surroundings;
    if (arm && !fingers && !rules.arm.overlap_by_design(geom(0), geom(1))) ++count;
  }
  return count;
}

}  // namespace

struct BatchSim::Impl {
  Impl(const Model& source, const Arm& whose) : model(source), arm(whose) {}

  Model model;
  Arm arm;
  int count = 0;
  int nstate = 0;
  std::unique_ptr<mjBatch, DeleteBatch> batch;

  // Memory of the batch. Components of the state are nstate apart from world to world.
  double* rows = nullptr;
  mjWarningStat* warnings = nullptr;
  double *time = nullptr, *qpos = nullptr, *qvel = nullptr, *ctrl = nullptr, *mocap = nullptr;
  const double* bias = nullptr;
  const double *tool_p = nullptr, *tool_R = nullptr;  ///< of all sites or bodies
  int frames = 0;                                     ///< how many those are
  int tool = 0;                                       ///< which one
  const int* ncon = nullptr;

  std::vector<Part> part_of_geom;
  std::vector<double> initial;  ///< row of a world in the initial state
  std::vector<int> contacts;
  std::vector<std::uint8_t> failed;
  std::vector<std::string> errors;
  std::vector<int> live;      ///< worlds that are stepped, rising
  std::vector<int> touched;   ///< scratch
  std::vector<double> times;  ///< [s] before the step

  [[nodiscard]] const mjModel& m() const { return *model.raw(); }
  /// Where the row of a world begins.
  [[nodiscard]] std::ptrdiff_t at(int world) const { return std::ptrdiff_t{world} * nstate; }
  [[nodiscard]] Result<void> make(int worlds, int threads);
  [[nodiscard]] Result<void> bind();
  int call(int (*work)(mjBatch*, const int*, int, int), std::span<const int> worlds, int argument);
  void count_contacts(std::span<const int> worlds);
  [[nodiscard]] std::string failure(int world) const;
  int take_failures(std::span<const int> worlds);
  void forget_failure(int world);
  void find_live();
};

Result<void> BatchSim::Impl::make(int worlds, int threads) {
  if (worlds < 1 || worlds > kMaxWorlds) {
    return fail(Errc::usage, text(msg::sim_batch_count, worlds, kMaxWorlds));
  }
  if (threads < 1 || threads > kMaxThreads) {
    return fail(Errc::usage, text(msg::sim_batch_threads, threads, kMaxThreads));
  }
  count = worlds;
  std::array<char, 500> why{};
  mjBatch* made = nullptr;
  const MujocoOutcome said = call_mujoco([&] {
    mjBatchConfig config;
    mjb_defaultConfig(&config);
    config.nthread = threads;
    config.persistent = 1;  // so that what is read after a step is not computed again by the next
    made = mjb_makeBatch(&m(), count, &config, why.data(), static_cast<int>(why.size()));
  });
  batch.reset(made);
  if (said.failed || !batch) {
    return fail(Errc::impossible, text(msg::sim_batch_refused, model.file().string(),
                                       said.failed ? said.error : std::string(why.data())));
  }
  return bind();
}

Result<void> BatchSim::Impl::bind() {
  part_of_geom = parts_of(m(), arm);
  contacts.assign(count, 0);
  failed.assign(count, 0);
  errors.resize(count);
  touched.reserve(count);
  times.resize(count);
  find_live();

  const int site = mj_name2id(&m(), mjOBJ_SITE, arm.tip.c_str());
  tool = site >= 0 ? site : mj_name2id(&m(), mjOBJ_BODY, arm.tip.c_str());
  frames = site >= 0 ? static_cast<int>(m().nsite) : static_cast<int>(m().nbody);
  assert(tool >= 0 && "the arm is of another model");
  const MujocoOutcome said = call_mujoco([this, site] {
    mjBatch* b = batch.get();
    const auto component = [b](int which) { return mjb_stateComponent(b, which, nullptr); };
    const auto output = [b](const char* name) { return mjb_output(b, name, nullptr, nullptr); };
    nstate = mjb_nstate(b);
    rows = mjb_state(b);
    warnings = mjb_warning(b);
    time = component(mjSTATE_TIME);
    qpos = component(mjSTATE_QPOS);
    qvel = component(mjSTATE_QVEL);
    ctrl = component(mjSTATE_CTRL);
    mocap = component(mjSTATE_MOCAP_POS);
    bias = static_cast<const double*>(output("qfrc_bias"));
    tool_p = static_cast<const double*>(output(site >= 0 ? "site_xpos" : "xpos"));
    tool_R = static_cast<const double*>(output(site >= 0 ? "site_xmat" : "xmat"));
    ncon = static_cast<const int*>(output("ncon"));
    mjb_reset(b, nullptr, 0, nullptr, mjSTAGE_NONE);
  });
  if (said.failed) {
    return fail(Errc::impossible, text(msg::sim_batch_refused, model.file().string(), said.error));
  }
  initial.assign(rows, rows + nstate);
  call(mjb_forward, live, mjSTAGE_ACC);
  return {};
}

/// Runs `work` on some worlds and takes note of what became of them; returns how many failed.
int BatchSim::Impl::call(int (*work)(mjBatch*, const int*, int, int), std::span<const int> worlds,
                         int argument) {
  if (worlds.empty()) return 0;
  const MujocoOutcome said = call_mujoco(
      [&] { work(batch.get(), worlds.data(), static_cast<int>(worlds.size()), argument); });
  // Only a call with wrong arguments ends up here; what goes wrong in a world has its status.
  assert(!said.failed);
  for (const std::string& warning : said.warnings) log_warning(text(msg::sim_mujoco, warning));
  count_contacts(worlds);
  return take_failures(worlds);
}

void BatchSim::Impl::count_contacts(std::span<const int> worlds) {
  touched.clear();
  for (const int world : worlds) {
    contacts[world] = 0;
    if (ncon[world] > 0) touched.push_back(world);
  }
  if (touched.empty()) return;
  ContactCount job{m(), arm, part_of_geom, contacts};
  job.give();
  mjb_apply(
      batch.get(), touched.data(), static_cast<int>(touched.size()),
      [](const mjModel*, mjData* d, int world, void* context) {
        auto& counting = *static_cast<ContactCount*>(context);
        counting.take();
        counting.contacts[world] = contacts_that_count(*d, counting);
        counting.give();
      },
      &job, 0);
  job.take();
}

/// Why a world failed, empty where it did not.
std::string BatchSim::Impl::failure(int world) const {
  if (mjb_status(batch.get())[world] != 0) {
    return text(msg::sim_fatal, times[world], mjb_error(batch.get(), world));
  }
  const mjWarningStat* warning = warnings + std::ptrdiff_t{world} * mjNWARNING;
  if (raw::unstable(warning)) return raw::instability(m(), warning, times[world]);
  if (warning[mjWARN_BADCTRL].number > 0) {
    const int actuator = warning[mjWARN_BADCTRL].lastinfo;
    const char* name = mj_id2name(&m(), mjOBJ_ACTUATOR, actuator);
    return text(msg::sim_bad_ctrl, times[world], actuator, name != nullptr ? name : "-");
  }
  return {};
}

int BatchSim::Impl::take_failures(std::span<const int> worlds) {
  int now = 0;
  for (const int world : worlds) {
    std::string why = failure(world);
    if (why.empty()) continue;
    failed[world] = 1;
    errors[world] = std::move(why);
    ++now;
  }
  if (now > 0) find_live();
  return now;
}

void BatchSim::Impl::forget_failure(int world) {
  mjWarningStat* warning = warnings + std::ptrdiff_t{world} * mjNWARNING;
  std::fill_n(warning, static_cast<int>(mjNWARNING), mjWarningStat{});
  failed[world] = 0;
  errors[world].clear();
  times[world] = time[at(world)];
}

void BatchSim::Impl::find_live() {
  live.clear();
  for (int world = 0; world < count; ++world) {
    if (failed[world] == 0) live.push_back(world);
  }
}

BatchSim::BatchSim(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BatchSim::~BatchSim() = default;
BatchSim::BatchSim(BatchSim&&) noexcept = default;
BatchSim& BatchSim::operator=(BatchSim&&) noexcept = default;

Result<BatchSim> BatchSim::create(const Model& model, const Arm& arm, int count, int threads) {
  auto impl = std::make_unique<Impl>(model, arm);
  if (auto made = impl->make(count, threads); !made) return fail(std::move(made.error()));
  return BatchSim(std::move(impl));
}

int BatchSim::count() const noexcept { return impl_->count; }
const Model& BatchSim::model() const noexcept { return impl_->model; }
int BatchSim::mocaps() const noexcept { return static_cast<int>(impl_->m().nmocap); }

void BatchSim::place(std::span<const int> worlds, std::span<const double> qpos,
                     std::span<const double> ctrl, std::span<const double> mocap) {
  Impl& b = *impl_;
  const std::ptrdiff_t nq = b.m().nq, nu = b.m().nu, nm = 3 * b.m().nmocap;
  assert(std::is_sorted(worlds.begin(), worlds.end()));
  assert(qpos.size() == worlds.size() * nq && ctrl.size() == worlds.size() * nu);
  assert(mocap.empty() || mocap.size() == worlds.size() * nm);
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const int world = worlds[i];
    const std::ptrdiff_t at = b.at(world);
    std::copy(b.initial.begin(), b.initial.end(), b.rows + at);
    std::copy_n(qpos.data() + i * nq, nq, b.qpos + at);
    std::copy_n(ctrl.data() + i * nu, nu, b.ctrl + at);
    if (!mocap.empty()) std::copy_n(mocap.data() + i * nm, nm, b.mocap + at);
    b.forget_failure(world);
  }
  b.find_live();
  b.call(mjb_forward, worlds, mjSTAGE_ACC);
}

int BatchSim::step(int steps) {
  assert(steps > 0);
  for (const int world : impl_->live) impl_->times[world] = time(world);
  return impl_->call([](mjBatch* batch, const int* worlds, int count,
                        int times) { return mjb_step(batch, worlds, count, times, mjSTAGE_VEL); },
                     impl_->live, steps);
}

std::span<double> BatchSim::ctrl(int world) noexcept {
  return {impl_->ctrl + impl_->at(world), static_cast<std::size_t>(impl_->m().nu)};
}
std::span<const double> BatchSim::ctrl(int world) const noexcept {
  return {impl_->ctrl + impl_->at(world), static_cast<std::size_t>(impl_->m().nu)};
}
std::span<const double> BatchSim::qpos(int world) const noexcept {
  return {impl_->qpos + impl_->at(world), static_cast<std::size_t>(impl_->m().nq)};
}
std::span<const double> BatchSim::qvel(int world) const noexcept {
  return {impl_->qvel + impl_->at(world), static_cast<std::size_t>(impl_->m().nv)};
}
double BatchSim::time(int world) const noexcept { return impl_->time[impl_->at(world)]; }

std::span<const double> BatchSim::bias(int world) const noexcept {
  const std::ptrdiff_t nv = impl_->m().nv;
  return {impl_->bias + world * nv, static_cast<std::size_t>(nv)};
}

Pose BatchSim::tool(int world) const noexcept {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const std::ptrdiff_t frame = std::ptrdiff_t{world} * impl_->frames + impl_->tool;
  return {Eigen::Map<const Eigen::Vector3d>(impl_->tool_p + 3 * frame),
          Eigen::Map<const RowMajor>(impl_->tool_R + 9 * frame)};
}

int BatchSim::contacts(int world) const noexcept { return impl_->contacts[world]; }
bool BatchSim::failed(int world) const noexcept { return impl_->failed[world] != 0; }
const std::string& BatchSim::error(int world) const noexcept { return impl_->errors[world]; }

Snapshot BatchSim::snapshot(int world) const {
  const double* row = impl_->rows + impl_->at(world);
  return {time(world), std::vector<double>(row, row + impl_->nstate)};
}

std::vector<double> BatchSim::state() const {
  const Impl& b = *impl_;
  std::vector<double> state(b.rows, b.rows + b.at(b.count));
  state.insert(state.end(), b.failed.begin(), b.failed.end());
  return state;
}

Result<void> BatchSim::set_state(std::span<const double> state) {
  Impl& b = *impl_;
  const std::size_t size = static_cast<std::size_t>(b.count) * (b.nstate + 1);
  if (state.size() != size) {
    return fail(Errc::bad_input, text(msg::sim_other_snapshot, state.size(), size));
  }
  std::copy_n(state.data(), b.at(b.count), b.rows);
  for (int world = 0; world < b.count; ++world) {
    b.forget_failure(world);
    b.failed[world] = state[b.at(b.count) + world] != 0 ? 1 : 0;
  }
  b.find_live();
  // Only what a step leaves behind: accelerations would change where the next solver starts.
  b.call(mjb_forward, b.live, mjSTAGE_VEL);
  return {};
}

}  // namespace mjarm
