#include "mjarm/trajectory/retime_kernel_internal.hpp"

namespace mjarm::detail {

double retime_value_avx512(RetimeLanes& lanes, const double* c, double mu) {
  return value_in_lanes(lanes, c, mu);
}
void retime_model_avx512(RetimeLanes& lanes, const double* c, double mu) {
  model_in_lanes(lanes, c, mu);
}

}  // namespace mjarm::detail
