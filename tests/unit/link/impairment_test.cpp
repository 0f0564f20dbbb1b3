// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impairment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/link/any_impairment.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Grouping = PathImpairment::Grouping;
using LawKind = DurationLaw::Kind;

Impairment parsed(std::string_view text) {
  auto impairment = parse_impairment(text);
  if (!impairment) ADD_FAILURE() << describe(impairment.error());
  return impairment ? *impairment : Impairment{};
}

/// The line that a user reads.
std::string refused_by_line(std::string_view text) {
  const auto impairment = parse_impairment(text);
  return impairment ? "accepted " + to_string(*impairment) : describe(impairment.error());
}

TEST(ParseImpairment, ReadsWhatTheManualShows) {
  PathImpairment both;
  both.loss = 0.001;
  both.delay = {LawKind::kNormal, 2ms, 1ms};
  both.split = {Grouping::kRandom, 0};
  EXPECT_EQ(parsed("loss=0.1%,delay=normal(2ms,1ms),split=random"), (Impairment{both, both, 1}));
}

TEST(ParseImpairment, ReadsEveryOption) {
  PathImpairment both;
  both.chunk = 64;
  both.bit_errors = 1e-6;
  both.loss = 0.01;
  both.doubling = 0.02;
  both.reordering = {0.03, 5ms};
  both.split = {Grouping::kFixed, 7};
  both.merge = {Grouping::kFixed, 512, 3ms};
  both.delay = {LawKind::kUniform, 100us, 1500us};
  both.bandwidth = 300'000;
  both.stall = {0.25, {LawKind::kExponential, 1s, {}}};
  both.disconnect = 1e-5;
  both.disconnect_after = 1000;
  EXPECT_EQ(parsed("chunk=64,bit-errors=1e-6,loss=0.01,double=2%,reorder=3%:5ms,split=7,"
                   "merge=512:3ms,delay=uniform(100us,1.5ms),bandwidth=300k,"
                   "stall=25%:exponential(1s),disconnect=0.001%,disconnect-after=1000,seed=99"),
            (Impairment{both, both, 99}));
}

TEST(ParseImpairment, HasWaitsOfItsOwnForReorderAndMerge) {
  const auto path = parsed("reorder=1%,merge=random").out;
  EXPECT_EQ(path.reordering.wait, 20ms);
  EXPECT_EQ(path.merge, (PathImpairment::Merge{Grouping::kRandom, 0, 16ms}));
}

TEST(ParseImpairment, TakesADurationForAConstantDelay) {
  EXPECT_EQ(parsed("delay=250ns").in.delay, (DurationLaw{LawKind::kConstant, 250ns, {}}));
  EXPECT_EQ(parsed("delay=constant(1s)").in.delay, (DurationLaw{LawKind::kConstant, 1s, {}}));
}

TEST(ParseImpairment, TakesADirection) {
  const auto impairment = parsed("out.loss=1%,in.delay=2ms");
  PathImpairment out;
  out.loss = 0.01;
  PathImpairment in;
  in.delay = {LawKind::kConstant, 2ms, {}};
  EXPECT_EQ(impairment, (Impairment{out, in, 1}));
}

TEST(ParseImpairment, LetsADirectionComeBeforeBothWhereverItStands) {
  for (const auto* const text : {"in.loss=0,loss=5%", "loss=5%,in.loss=0"}) {
    const auto impairment = parsed(text);
    EXPECT_EQ(impairment.out.loss, 0.05);
    EXPECT_EQ(impairment.in.loss, 0);
  }
}

TEST(ParseImpairment, AllowsBlanks) {
  EXPECT_EQ(parsed(" loss = 1% , delay = normal( 2ms , 1ms ) "),
            parsed("loss=1%,delay=normal(2ms,1ms)"));
}

TEST(ParseImpairment, TakesALinkWithoutDefects) {
  EXPECT_EQ(parsed("seed=1"), Impairment{});
  EXPECT_EQ(parsed("loss=0,reorder=0:1s,stall=0%:1s,delay=0s"), Impairment{});
}

TEST(ParseImpairment, TakesTheLargestSeed) {
  EXPECT_EQ(parsed("seed=18446744073709551615").seed, 18446744073709551615U);
}

struct Refused {
  std::string_view text;
  std::string_view line;
};

TEST(ParseImpairment, RefusesEachMistakeInOneLineThatSaysWhatToDo) {
  const std::vector<Refused> mistakes{
      {"", "impairment '': write NAME=VALUE, as in loss=1%,delay=2ms"},
      {"loss=1%,", "impairment '': write NAME=VALUE, as in loss=1%,delay=2ms"},
      {"loss", "impairment 'loss': write NAME=VALUE, as in loss=1%"},
      {"loss=", "impairment 'loss=': '' is no rate: write 0.001 or 0.1%"},
      {"loss=much", "impairment 'loss=much': 'much' is no rate: write 0.001 or 0.1%"},
      {"loss=1ms", "impairment 'loss=1ms': '1ms' is no rate: write 0.001 or 0.1%"},
      {"loss=nan", "impairment 'loss=nan': 'nan' is no rate: write 0.001 or 0.1%"},
      {"loss=5", "impairment 'loss=5': 5 is beyond 0 to 1, which is 0% to 100%"},
      {"loss=101%", "impairment 'loss=101%': 101% is beyond 0 to 1, which is 0% to 100%"},
      {"in.loss=-1%", "impairment 'in.loss=-1%': -1% is beyond 0 to 1, which is 0% to 100%"},
      {"delay=2", "impairment 'delay=2': '2' needs a unit that is ns, us, ms or s, as in 2ms"},
      {"delay=2min",
       "impairment 'delay=2min': '2min' needs a unit that is ns, us, ms or s, as in 2ms"},
      {"delay=2ms)",
       "impairment 'delay=2ms)': '2ms)' needs a unit that is ns, us, ms or s, as in 2ms"},
      {"delay=long",
       "impairment 'delay=long': 'long' is no duration: write a number and ns, us, ms or s"},
      {"delay=-1ms", "impairment 'delay=-1ms': -1ms is beyond 0s to 3600s"},
      {"delay=3601s", "impairment 'delay=3601s': 3601s is beyond 0s to 3600s"},
      {"delay=gauss(1ms,1ms)",
       "impairment 'delay=gauss(1ms,1ms)': no law is called 'gauss': write 2ms, uniform(1ms,3ms), "
       "normal(2ms,1ms) or exponential(2ms)"},
      {"delay=normal(2ms)",
       "impairment 'delay=normal(2ms)': normal takes two durations: write 2ms, uniform(1ms,3ms), "
       "normal(2ms,1ms) or exponential(2ms)"},
      {"delay=exponential(2ms,1ms)",
       "impairment 'delay=exponential(2ms,1ms)': exponential takes one duration: write 2ms, "
       "uniform(1ms,3ms), normal(2ms,1ms) or exponential(2ms)"},
      {"delay=uniform(3ms,1ms)",
       "impairment 'delay=uniform(3ms,1ms)': 1ms is less than 3ms: write uniform(LEAST,MOST)"},
      {"delay=normal(2ms,1ms,loss=1%",
       "impairment 'delay=normal(2ms,1ms,loss=1%': 'normal(2ms,1ms,loss=1%' lacks its closing "
       "parenthesis"},
      {"delay=normal(2ms,x)",
       "impairment 'delay=normal(2ms,x)': 'x' is no duration: write a number and ns, us, ms or s"},
      {"split=0", "impairment 'split=0': '0' is neither a number of bytes, 1 or more, nor random"},
      {"split=half",
       "impairment 'split=half': 'half' is neither a number of bytes, 1 or more, nor random"},
      {"merge=0:1ms",
       "impairment 'merge=0:1ms': '0' is neither a number of bytes, 1 or more, nor random"},
      {"merge=8:soon",
       "impairment 'merge=8:soon': 'soon' is no duration: write a number and ns, us, ms or s"},
      {"reorder=1%:2",
       "impairment 'reorder=1%:2': '2' needs a unit that is ns, us, ms or s, as in 2ms"},
      {"chunk=0", "impairment 'chunk=0': '0' is not a number of bytes, 1 or more"},
      {"chunk=-3", "impairment 'chunk=-3': '-3' is not a number of bytes, 1 or more"},
      {"chunk=1.5", "impairment 'chunk=1.5': '1.5' is not a number of bytes, 1 or more"},
      {"disconnect-after=0",
       "impairment 'disconnect-after=0': '0' is not a number of bytes, 1 or more"},
      {"bandwidth=0",
       "impairment 'bandwidth=0': '0' is no bandwidth: write bytes a second, 1 to 10^12, as in "
       "11520, 300k or 1M"},
      {"bandwidth=2000000M",
       "impairment 'bandwidth=2000000M': '2000000M' is no bandwidth: write bytes a second, 1 to "
       "10^12, as in 11520, 300k or 1M"},
      {"stall=1%", "impairment 'stall=1%': write RATE:LENGTH, as in 0.1%:50ms"},
      {"stall=1%:50",
       "impairment 'stall=1%:50': '50' needs a unit that is ns, us, ms or s, as in 2ms"},
      {"seed=-1", "impairment 'seed=-1': '-1' is not a whole number below 2^64"},
      {"seed=18446744073709551616",
       "impairment 'seed=18446744073709551616': '18446744073709551616' is not a whole number below "
       "2^64"},
      {"in.seed=1", "impairment 'in.seed=1': the seed is for both directions: write seed=N"},
      {"loss=1%,loss=2%", "impairment 'loss=2%': loss is given twice: leave one out"},
      {"in.loss=1%,in.loss=1%", "impairment 'in.loss=1%': loss is given twice: leave one out"},
  };
  for (const auto& [text, line] : mistakes) EXPECT_EQ(refused_by_line(text), line);
}

TEST(ParseImpairment, NamesTheOptionsToWhomItRefusesOne) {
  EXPECT_EQ(refused_by_line("los=1%"),
            "impairment 'los=1%': no such option; did you mean 'loss'? known: chunk, bit-errors, "
            "loss, double, reorder, "
            "split, merge, delay, bandwidth, stall, disconnect, disconnect-after, seed");
}

TEST(ParseImpairment, NamesTheDirectionsToWhomItRefusesOne) {
  EXPECT_EQ(refused_by_line("tx.loss=1%"),
            "impairment 'tx.loss=1%': no such option; the directions are out. (to the device) and "
            "in. (from it)");
}

TEST(ParseImpairment, RefusesEveryBeginningOfATextWithoutCrashing) {
  constexpr std::string_view kText =
      "stall=25%:exponential(1s),in.delay=uniform(100us,1.5ms),seed=9";
  for (std::size_t size = 0; size < kText.size(); ++size) {
    EXPECT_THAT(refused_by_line(kText.substr(0, size)),
                StartsWith(size == 25 || size == 62 ? "acc" : ""));
  }
}

TEST(ImpairmentText, NamesOnlyWhatIsThereAndTheSeed) {
  EXPECT_EQ(to_string(Impairment{}), "seed=1");
  EXPECT_EQ(to_string(parsed("split=random,delay=normal(2ms,1500us),loss=0.1%")),
            "loss=0.1%,split=random,delay=normal(2ms,1500us),seed=1");
}

TEST(ImpairmentText, NamesADirectionWhereTheyDiffer) {
  EXPECT_EQ(to_string(parsed("loss=1%,in.loss=2%,out.bandwidth=1M,seed=3")),
            "out.loss=1%,in.loss=2%,out.bandwidth=1000000,seed=3");
}

TEST(ImpairmentText, ShowsRatesAsPeopleWriteThem) {
  EXPECT_EQ(to_string(parsed("bit-errors=1e-6,loss=0.07,double=0.123456789012,disconnect=100%")),
            "bit-errors=1e-06,loss=7%,double=0.123456789012,disconnect=100%,seed=1");
}

TEST(ImpairmentText, IsReadAsTheSameImpairment) {
  test::for_all(
      [] {
        const auto impairment = test::any_impairment();
        const auto again = parse_impairment(to_string(impairment));
        RC_LOG() << to_string(impairment);
        RC_ASSERT(again.has_value());
        RC_ASSERT(*again == impairment);
      },
      2000);
}

TEST(ImpairmentForms, NameEveryOption) {
  const auto forms = impairment_forms();
  for (const auto* const name :
       {"chunk=", "bit-errors=", "loss=", "double=", "reorder=", "split=", "merge=", "delay=",
        "bandwidth=", "stall=", "disconnect=", "disconnect-after=", "seed=", "out.NAME="}) {
    EXPECT_THAT(forms, HasSubstr(name));
  }
}

TEST(ImpairmentForms, FitOnATerminal) {
  std::string_view forms{};
  const auto text = impairment_forms();
  forms = text;
  while (!forms.empty()) {
    const auto end = forms.find('\n');
    EXPECT_LE(end, 100U) << forms.substr(0, end);
    forms.remove_prefix(end + 1);
  }
}

}  // namespace
}  // namespace armjig
