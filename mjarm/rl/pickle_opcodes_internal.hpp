#pragma once

#include <string>

namespace mjarm::rl {

/// The instructions of pickles that a state_dict needs.
enum class PickleOp : unsigned char {
  mark = '(',
  stop = '.',
  bin_int = 'J',
  bin_int1 = 'K',
  bin_int2 = 'M',
  none = 'N',
  bin_pers_id = 'Q',
  reduce = 'R',
  bin_unicode = 'X',
  build = 'b',
  global = 'c',
  bin_get = 'h',
  long_bin_get = 'j',
  bin_put = 'q',
  long_bin_put = 'r',
  set_item = 's',
  tuple = 't',
  empty_tuple = ')',
  set_items = 'u',
  empty_dict = '}',
  proto = 0x80,
  tuple1 = 0x85,
  tuple2 = 0x86,
  tuple3 = 0x87,
  new_true = 0x88,
  new_false = 0x89,
};

/// Name of any instruction of pickles, as pickletools gives it; its number where there is none.
[[nodiscard]] std::string pickle_op_name(unsigned char code);

}  // namespace mjarm::rl
