#include "apps/mjarm/commands/processes.hpp"

#include <array>
#include <cstdlib>
#include <string>

#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/os.hpp"

#ifdef MJARM_MPI
#include <mpi.h>
#endif

namespace mjarm::app {
namespace {

/// How many processes the starter of this one says there are: Open MPI, MPICH and Slurm.
int processes_announced() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"}) {
    if (const auto size = environment(name)) return std::atoi(size->c_str());
  }
  return 1;
}

#ifdef MJARM_MPI
/// All sums go through rank 0, which hands the result out: MPI_Allreduce may round differently on
/// each rank, and then their policies would drift apart.
class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiRanks() override { MPI_Finalize(); }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override { return size_; }
  void sum(std::span<double> values) override { sum(values.data(), values.size(), MPI_DOUBLE); }
  void sum(std::span<float> values) override { sum(values.data(), values.size(), MPI_FLOAT); }

 private:
  void sum(void* values, std::size_t count, MPI_Datatype type) const {
    const int n = static_cast<int>(count);
    if (rank_ == 0) {
      MPI_Reduce(MPI_IN_PLACE, values, n, type, MPI_SUM, 0, MPI_COMM_WORLD);
    } else {
      MPI_Reduce(values, nullptr, n, type, MPI_SUM, 0, MPI_COMM_WORLD);
    }
    MPI_Bcast(values, n, type, 0, MPI_COMM_WORLD);
  }

  int rank_ = 0;
  int size_ = 1;
};
#endif

}  // namespace

Result<std::unique_ptr<Ranks>> join_processes() {
  if (processes_announced() <= 1) return nullptr;
#ifdef MJARM_MPI
  int provided = 0;  // only the main thread calls MPI; the others simulate and multiply
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS) {
    return fail(Errc::not_available, text(msg::train_mpi_failed));
  }
  return std::make_unique<MpiRanks>();
#else
  return fail(Errc::not_available, text(msg::train_no_mpi, processes_announced()));
#endif
}

}  // namespace mjarm::app
