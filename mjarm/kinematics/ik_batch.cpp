#include "mjarm/kinematics/ik_batch.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include "mjarm/core/threads.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kChunk = 64;  // poses that a thread takes at a time

/// The poses still to be solved, shared by the threads.
class Batch {
 public:
  Batch(std::span<const Pose> X_WT, std::span<const double> q_seed, std::size_t dof)
      : X_WT_(X_WT),
        q_seed_(q_seed),
        dof_(dof),
        stride_(q_seed.size() == dof ? 0 : dof),
        answers_(X_WT.size(), fail(IkFailure{})) {}

  /// Solves chunks until none is left; `tell` is called after each.
  template <class Tell>
  void work(const IkSolver& ik, Tell tell) noexcept {
    for (;;) {
      const std::size_t first = next_.fetch_add(kChunk);
      if (first >= X_WT_.size()) return;
      const std::size_t last = std::min(first + kChunk, X_WT_.size());
      for (std::size_t i = first; i < last; ++i) {
        answers_[i] = ik.solve(X_WT_[i], seed(i));
      }
      tell(done_.fetch_add(last - first) + last - first);
    }
  }

  std::vector<Result<IkSolution, IkFailure>> take() { return std::move(answers_); }

 private:
  /// The seed of pose `i`; of a wrong size where there is none for it.
  std::span<const double> seed(std::size_t i) const {
    if (stride_ != 0 && q_seed_.size() != X_WT_.size() * dof_) return {};
    return q_seed_.subspan(i * stride_, dof_);
  }

  std::span<const Pose> X_WT_;
  std::span<const double> q_seed_;
  std::size_t dof_, stride_;
  std::vector<Result<IkSolution, IkFailure>> answers_;
  std::atomic<std::size_t> next_{0}, done_{0};
};

}  // namespace

std::vector<Result<IkSolution, IkFailure>> solve_batch(const IkSolver& ik,
                                                       std::span<const Pose> X_WT,
                                                       std::span<const double> q_seed,
                                                       const IkBatchOptions& options) {
  Batch batch(X_WT, q_seed, static_cast<std::size_t>(ik.arm().dof()));
  const unsigned wish = options.threads > 0 ? static_cast<unsigned>(options.threads)
                                            : std::thread::hardware_concurrency();
  const std::size_t max = (X_WT.size() + kChunk - 1) / kChunk;
  run_in_threads(static_cast<int>(std::min<std::size_t>(wish, max)), [&](int thread) {
    const IkSolver own = ik;
    batch.work(own, [&](std::size_t done) {
      if (thread == 0 && options.progress) options.progress(done);
    });
  });
  if (options.progress && !X_WT.empty()) options.progress(X_WT.size());
  return batch.take();
}

}  // namespace mjarm
