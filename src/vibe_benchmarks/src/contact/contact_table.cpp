#include "contact/contact_table.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "output/result_row.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {
namespace {

std::string textOf(const ContactSetting& setting) {
  const std::string text =
      formatted("%d Hz, %d it, radius %g", setting.rate, setting.iterations, setting.spectral_radius);
  return text + (setting.threads > 1 ? ", " + std::to_string(setting.threads) + " threads" : std::string());
}

bool differInThreads(const ContactSetting& a, const ContactSetting& b) {
  return a.threads != b.threads && a.rate == b.rate && a.iterations == b.iterations &&
         a.spectral_radius == b.spectral_radius;
}

ContactRow rowOf(const std::string& name, ContactTrace trace, const std::optional<ContactTrace>& reference) {
  ContactRow row;
  row.name = name;
  row.setting = trace.setting;
  row.times = timesOf(trace.cpu);
  row.wall = timesOf(trace.wall);
  if (reference) row.errors = compareContact(trace, *reference);
  trace.frames.clear();
  trace.force.clear();
  row.trace = std::move(trace);
  return row;
}

/// The cases to run; the free pull always comes first, because all times are relative to it.
std::vector<std::string> namesOf(const ContactPlan& plan) {
  std::vector<std::string> names = plan.names.empty() ? contactStateNames() : plan.names;
  const std::string& first = contactStateNames().front();
  names.erase(std::remove(names.begin(), names.end(), first), names.end());
  names.insert(names.begin(), first);
  return names;
}

class Table {
 public:
  Table(const ContactPlan& plan, std::ostream& log) : plan_(plan), log_(log) {}

  void addCase(const ContactCase& one) {
    std::optional<ContactTrace> reference;
    if (plan_.reference) {
      log_ << one.name << ": reference, " << textOf(*plan_.reference) << std::endl;
      reference = runContact(one, *plan_.reference);
    }
    for (ContactTrace& trace : runSettings(one)) add(rowOf(one.name, std::move(trace), reference));
  }

  std::vector<ContactRow> takeRows() { return std::move(rows_); }

 private:
  // In turn, so that what else the machine does meets all of them alike.
  std::vector<ContactTrace> runSettings(const ContactCase& one) const {
    std::vector<ContactTrace> traces;
    for (const ContactSetting& setting : plan_.settings) {
      traces.push_back(runContact(one, setting));
      const ContactTrace* const before = traces.size() > 1 ? &traces[traces.size() - 2] : nullptr;
      if (before != nullptr && differInThreads(before->setting, setting) && before->hash != traces.back().hash)
        throw Error("The bits of '" + one.name + "' depend on the number of threads.");
    }
    for (int again = 1; again < plan_.repeats; ++again)
      for (ContactTrace& trace : traces) takeFaster(runContact(one, trace.setting), trace);
    return traces;
  }

  void add(ContactRow row) {
    const std::string setting = textOf(row.setting);
    if (row.name == contactStateNames().front()) free_[setting] = row.times.p50;
    const auto free = free_.find(setting);
    row.ratio = free == free_.end() ? 0 : row.times.p50 / free->second;
    log_ << row.name << ": " << setting << ", " << row.times.p50 << " ms per step" << std::endl << row.trace.stages;
    rows_.push_back(std::move(row));
  }

  const ContactPlan& plan_;
  std::ostream& log_;
  std::map<std::string, double> free_;  // median of the free pull per setting [ms]
  std::vector<ContactRow> rows_;
};

}  // namespace

std::vector<ContactRow> runContactStates(const Scene& scene, const std::string& urdf, const ContactPlan& plan,
                                         std::ostream& log) {
  const Arithmetic measured = arithmetic(), preparing = plan.plain_preparation ? Arithmetic::Plain : measured;
  setArithmetic(preparing);
  ContactStates states(scene, urdf, log);
  Table table(plan, log);
  for (const std::string& name : namesOf(plan)) {
    setArithmetic(preparing);
    const ContactCase one = states.prepare(name);
    setArithmetic(measured);
    table.addCase(one);
  }
  return table.takeRows();
}

void writeContactRows(const std::vector<ContactRow>& rows, std::ostream& out) {
  out << "state,rate,iterations,spectral_radius,ms_mean,ms_p50,ms_p99,ms_max,ratio_to_free,iterations_mean,"
         "iterations_max,fallback_steps,contacts,pairs,crossings,depth_mm,events,balance_J,work_J,motion_error,"
         "motion_error_end,force_error,force_error_end,largest_force_N,state_hash,threads,ms_wall_mean,ms_wall_p50,ms_"
         "wall_p99,ms_all_threads\n";
  for (const ContactRow& row : rows) {
    const ContactTrace& t = row.trace;
    out << formatted("%s,%d,%d,%g,%.4g,%.4g,%.4g,%.4g,%.4g,%.3g,%d,%d,%d,%d,%d,%.4g,%d,%.6g,%.6g,", row.name.c_str(),
                     row.setting.rate, row.setting.iterations, row.setting.spectral_radius, row.times.mean,
                     row.times.p50, row.times.p99, row.times.max, row.ratio, t.iterations, t.max_iterations,
                     t.fallback_steps, t.contacts, t.pairs, t.crossings, 1e3 * t.depth, t.events, t.balance, t.work);
    if (row.errors)
      out << formatted("%.4g,%.4g,%.4g,%.4g,%.4g,%016llx", row.errors->motion, row.errors->motion_end,
                       row.errors->force, row.errors->force_end, row.errors->largest,
                       static_cast<unsigned long long>(t.hash));
    else
      out << formatted(",,,,,%016llx", static_cast<unsigned long long>(t.hash));
    out << formatted(",%d,%.4g,%.4g,%.4g,%.4g\n", row.setting.threads, row.wall.mean, row.wall.p50, row.wall.p99,
                     row.times.mean + t.others);
  }
}

}  // namespace vibe::benchmarks
