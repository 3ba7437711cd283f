#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "mjarm/core/file.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/rl/pickle_opcodes_internal.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/sb3_file_test.hpp"
#include "mjarm/rl/torch_pickle_internal.hpp"

namespace mjarm::rl {
namespace {

using testing::expect_refused;
using testing::global;
using testing::integer;
using testing::kDictGlobal;
using testing::kFloatGlobal;
using testing::kTensorGlobal;
using testing::pickled_state;
using testing::unicode;

const std::string kEmptyDict = kDictGlobal + ")R";
const std::string kStorage =
    "(" + unicode("storage") + kFloatGlobal + unicode("0") + unicode("cpu") + integer(2) + "tQ";

void expect_pickle_refused(const std::string& pickle, const std::string& phrase) {
  SCOPED_TRACE(phrase);
  expect_refused(read_torch_pickle(pickle, "f"), "f: ", phrase);
}

/// The pickle in a policy of stable-baselines3.
std::string real_pickle() {
  const std::string file = read_file(testing::test_file("sb3_tanh.zip")).value();
  const auto outer = StoredZip::open(file, "f").value();
  const auto inner = StoredZip::open(outer.read_checked("policy.pth").value(), "f").value();
  return std::string(inner.read_checked(inner.name_ending_in("/data.pkl")).value());
}

TEST(TorchPickle, ReadsWhatTorchWrote) {
  const auto tensors = read_torch_pickle(real_pickle(), "f");
  ASSERT_TRUE(tensors) << tensors.error().what;
  ASSERT_EQ(tensors->size(), 13u);
  const PickledTensor& weight = tensors->at("mlp_extractor.policy_net.0.weight");
  EXPECT_EQ(weight.shape, (std::vector<std::int64_t>{8, 5}));
  EXPECT_EQ(weight.strides, (std::vector<std::int64_t>{5, 1}));
  EXPECT_EQ(weight.offset, 0);
  EXPECT_EQ(weight.count, 40);
  EXPECT_EQ(tensors->at("log_std").shape, (std::vector<std::int64_t>{2}));
}

TEST(TorchPickle, ReadsWhatTheTestsWrite) {
  const auto tensors = read_torch_pickle(pickled_state({{}, {.name = "v", .offset = 1}}), "f");
  ASSERT_TRUE(tensors) << tensors.error().what;
  EXPECT_EQ(tensors->at("v").offset, 1);
  EXPECT_EQ(tensors->at("w").storage, "0");
}

TEST(TorchPickle, AnyOtherGlobalIsNamedAndRefused) {
  for (const auto& [module, name] : std::vector<std::pair<std::string, std::string>>{
           {"os", "system"},
           {"posix", "system"},
           {"builtins", "eval"},
           {"builtins", "exec"},
           {"builtins", "getattr"},
           {"subprocess", "Popen"},
           {"torch", "DoubleStorage"},
           {"torch", "load"},
           {"torch.FloatStorage", "load"},
           {"torch._utils", "_rebuild_tensor_v3"},
           {"torch._utils", "_rebuild_parameter"},
           {"torch.storage", "_load_from_bytes"},
           {"collections", "OrderedDict.fromkeys"},
           {"collections", "defaultdict"},
           {"", "collections.OrderedDict"},
           {"numpy.core.multiarray", "_reconstruct"},
           {std::string("collections\0x", 13), "OrderedDict"}}) {
    const std::string pickle =
        "\x80\x02" + global(module, name) + "(" + unicode("touch /tmp/owned") + "tR.";
    expect_pickle_refused(pickle, name == "collections.OrderedDict" ? "asks for" : name + "\"");
    expect_pickle_refused(pickle, "refused");
  }
}

TEST(TorchPickle, AnyOtherInstructionIsNamedAndRefused) {
  const std::string known = "(.JKMNQRXbchjqrst)u}\x80\x85\x86\x87\x88\x89";
  ASSERT_EQ(known.size(), 26u);
  int refused = 0;
  for (int code = 0; code < 256; ++code) {
    if (known.find(static_cast<char>(code)) != std::string::npos) continue;
    // Before it stands whatever such an instruction might like to take.
    const std::string before = "\x80\x02(" + kDictGlobal + ")" + unicode("os system") + ")";
    const std::string pickle = before + static_cast<char>(code) + "os\nsystem\n.";
    expect_pickle_refused(pickle, "the instruction " +
                                      pickle_op_name(static_cast<unsigned char>(code)) + " (byte " +
                                      std::to_string(before.size()) + ")");
    ++refused;
  }
  EXPECT_EQ(refused, 256 - 26);
  EXPECT_EQ(pickle_op_name(0x93), "STACK_GLOBAL");
  EXPECT_EQ(pickle_op_name('i'), "INST");
  EXPECT_EQ(pickle_op_name(0xFF), "0xFF");
}

TEST(TorchPickle, NothingElseCanBeCalledOrBuilt) {
  const std::string start = "\x80\x02";
  expect_pickle_refused(start + kFloatGlobal + ")R.", "REDUCE");
  expect_pickle_refused(start + kDictGlobal + "(" + integer(1) + "tR.", "REDUCE");
  expect_pickle_refused(start + kTensorGlobal + ")R.", "REDUCE");
  expect_pickle_refused(start + kTensorGlobal + kEmptyDict + "R.", "REDUCE");
  expect_pickle_refused(start + unicode("os.system") + ")R.", "REDUCE");
  expect_pickle_refused(start + kEmptyDict + ")R.", "REDUCE");
  expect_pickle_refused(start + "R.", "REDUCE");
  expect_pickle_refused(start + ")R.", "REDUCE");
  expect_pickle_refused(start + "})b.", "BUILD");
  expect_pickle_refused(start + ")}b.", "BUILD");
  expect_pickle_refused(start + "b.", "BUILD");
  expect_pickle_refused(start + kFloatGlobal + "}b.", "BUILD");
  expect_pickle_refused(start + unicode("storage") + "Q.", "BINPERSID");
  expect_pickle_refused(start + ")Q.", "BINPERSID");
  expect_pickle_refused(start + "(" + unicode("module") + kFloatGlobal + unicode("0") +
                            unicode("cpu") + integer(2) + "tQ.",
                        "BINPERSID");
  expect_pickle_refused(start + "(" + unicode("storage") + kDictGlobal + unicode("0") +
                            unicode("cpu") + integer(2) + "tQ.",
                        "BINPERSID");
}

TEST(TorchPickle, DamageGetsOneLine) {
  const std::string start = "\x80\x02";
  expect_pickle_refused("", "ends within");
  expect_pickle_refused(start, "ends within");
  expect_pickle_refused("\x80\x04.", "PROTO");
  expect_pickle_refused(start + ".", "dictionary of tensors");
  expect_pickle_refused(start + "N.", "dictionary of tensors");
  expect_pickle_refused(start + kStorage + ".", "dictionary of tensors");
  expect_pickle_refused(start + "}}.", "dictionary of tensors");
  expect_pickle_refused(start + "}(.", "dictionary of tensors");
  expect_pickle_refused(start + "}" + unicode("w") + "Ns.", "dictionary of tensors");
  expect_pickle_refused(start + "}" + unicode("w") + "}s.", "dictionary of tensors");
  expect_pickle_refused(pickled_state({{}, {}}), "dictionary of tensors");  // a name twice
  expect_pickle_refused(pickled_state({{.strides = {1, 1}}}), "dictionary of tensors");
  expect_pickle_refused(start + "}.x", "1 bytes follow");
  expect_pickle_refused(start + "}NNs.", "SETITEM");
  expect_pickle_refused(start + ")" + unicode("w") + "Ns.", "SETITEM");
  expect_pickle_refused(start + "}N" + "s.", "SETITEM");
  expect_pickle_refused(start + "}u.", "SETITEMS");
  expect_pickle_refused(start + "}(Nu.", "SETITEMS");
  expect_pickle_refused(start + "(" + unicode("w") + "Nu.", "SETITEMS");
  expect_pickle_refused(start + "(}(" + unicode("w") + "N(u.", "SETITEMS");
  expect_pickle_refused(start + "}(" + unicode("w") + "(Ns.", "SETITEM");  // across a mark
  expect_pickle_refused(start + "t.", "TUPLE");
  expect_pickle_refused(start + "N\x86.", "TUPLE2");
  expect_pickle_refused(start + "N(N\x86.", "TUPLE2");  // across a mark
  expect_pickle_refused(start + "q\x01.", "BINPUT");
  expect_pickle_refused(start + "h\x01.", "BINGET");
  expect_pickle_refused(start + "Nq\x01j\x01\x01" + std::string(2, '\0') + ".", "LONG_BINGET");
  std::string wordy = "X";
  append_little<std::uint32_t>(wordy, 0xFFFFFFFFu);
  expect_pickle_refused(start + wordy + "words.", "ends within");
  // A tensor of other things than numbers.
  for (const std::string& parts :
       {"N" + integer(0) + ")" + ")" + "N}", kStorage + "N" + ")" + ")" + "N}",
        kStorage + integer(0) + "N" + ")" + "N}", kStorage + integer(0) + "(Nt" + ")" + "N}",
        kStorage + integer(0) + ")" + "}" + "N}",
        kStorage + integer(0) + ")" + "(" + unicode("1") + "t" + "N}"}) {
    std::string pickle = start;
    pickle += "}" + unicode("w") + kTensorGlobal + "(";
    pickle += parts + "tRs.";
    expect_pickle_refused(pickle, "dictionary of tensors");
  }
}

TEST(TorchPickle, BombsDoNotGoOff) {
  const std::string start = "\x80\x02";
  const auto many = [](const std::string& piece, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += piece;
    return out;
  };
  expect_pickle_refused(start + std::string(3000000, '('), "MARK");
  expect_pickle_refused(start + std::string(3000000, '('), "refused");
  expect_pickle_refused(start + std::string(3000000, 'N') + ".", "STACK");
  expect_pickle_refused(start + ")" + std::string(1000, '\x85') + ".", "dictionary");
  expect_pickle_refused(start + ")" + std::string(3000000, '\x85') + ".", "VALUES");
  // Each tuple holds the one before twice: 2^60 values, were they written out.
  expect_pickle_refused(start + ")q\x01" + many("h\x01h\x01\x86q\x01", 60) + ".", "dictionary");
  expect_pickle_refused(start + ")q\x01" + many("h\x01h\x01\x86q\x01", 500000) + ".", "S");
  // A dictionary that holds itself, alone and a million times.
  expect_pickle_refused(start + "}q\x01" + unicode("a") + "h\x01s.", "dictionary");
  expect_pickle_refused(start + unicode("a") + "q\x02}q\x01" + many("h\x02h\x01s", 600000) + ".",
                        "dictionary");
  // Memo: an index out of this world is fine, more of them than weights need are not.
  EXPECT_TRUE(read_torch_pickle(start + "}r\xFF\xFF\xFF\xFF.", "f"));
  std::string memos = start + "}";
  for (std::uint32_t i = 0; i < 200000; ++i) {
    memos += 'r';
    append_little(memos, i);
  }
  expect_pickle_refused(memos + ".", "MEMO");
  expect_pickle_refused(start + std::string(std::size_t{4} << 20, '}'), "more than the 4194304");
}

TEST(TorchPickle, IsRefusedCutOffAnywhere) {
  const std::string whole = real_pickle();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    expect_refused(read_torch_pickle(std::string_view(whole).substr(0, size), "f"), "f: ");
  }
}

TEST(TorchPickle, AnyBytesAreReadOrRefused) {
  const std::string whole = real_pickle();
  std::mt19937_64 random(7);
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = whole;
    for (std::uint64_t i = 1 + random() % 4; i-- > 0;) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    const auto read = read_torch_pickle(bytes, "f");
    if (!read) expect_refused(read, "f: ");
  }
  const std::string known = "(.JKMNQRXbchjqrst)u}\x80\x85\x86\x87\x88\x89";
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = "\x80\x02";
    for (std::uint64_t i = random() % 60; i-- > 0;) bytes += known[random() % known.size()];
    const auto read = read_torch_pickle(bytes, "f");
    if (!read) expect_refused(read, "f: ");
  }
}

}  // namespace
}  // namespace mjarm::rl
