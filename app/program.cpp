// Command line: options, and the run or the text that they request.

#include "app/program.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "accuracy/ladder.hpp"
#include "app/deck_files.hpp"
#include "app/provenance.hpp"
#include "app/runs.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "base/stop.hpp"
#include "base/threads.hpp"
#include "base/timing.hpp"
#include "deck/document.hpp"
#include "deck/words.hpp"
#include "record/citations.hpp"
#include "record/evaluation_cost.hpp"
#include "record/files/exit_code.hpp"
#include "record/files/file.hpp"
#include "record/new_deck.hpp"
#include "record/plan.hpp"
#include "record/results.hpp"
#include "record/series_manual.hpp"
#include "scene/scene.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solvers/options.hpp"

namespace tanktread {

namespace {

struct Arguments : DeckPlaces {
  std::vector<std::string> settings, accuracy;
  std::string output, new_deck;
  bool overwrite = false, check = false, reference = false, reference_series = false, rejections = false, schema = false, quiet = false;
  bool no_expect = false, cite = false;
  std::optional<int> threads;
};

/// Declares the options of the command line.
void declare_options(CLI::App& app, Arguments& arguments) {
  app.footer(
      "An expectation (Expect) belongs to the deck that states it. If an overlay or --set changes a key that results depend on and does not\n"
      "state the expectation again, a miss is reported and does not fail the run.\n"
      "Exit codes: 0 done, and all binding expectations are met; 1 an expectation is missed; 2 a mistake in the deck or the command line; "
      "3 the run failed; 4 the run was stopped by a signal or at its wall-clock limit, and --resume continues it if it is a run in time. For any "
      "code but 0, Open MPI's mpirun prints a page and waits for seconds; in its version 4, `mpirun -q --mca odls_base_sigkill_timeout 0` does "
      "not.");
  app.add_option("deck", arguments.decks, "the deck, and overlays that are laid over it key by key");
  app.add_option("--set", arguments.settings, "'Section/key=value': one key, after all decks (repeatable)")->allow_extra_args(false);
  app.add_option("--accuracy", arguments.accuracy,
                 "'[<particle>/]<series>[@end|@mean]=<value>[%]': runs on finer and finer levels until the error of the series is at most this "
                 "(repeatable; see Accuracy in the manual of keys)")
      ->allow_extra_args(false);
  const auto directory = [](const std::string& name) {
    return name.starts_with('-') ? "must be followed by a directory, but " + name + " is an option (a directory of that name is ./" + name + ")" : "";
  };
  app.add_option("--output", arguments.output,
                 "where results go (default: results/<deck name>, followed by what is laid over it: _<overlay name>, _<key>=<value>)")
      ->check(directory, "");
  app.add_flag("--overwrite", arguments.overwrite, "delete the results of an earlier run there");
  app.add_flag(
      "--check", arguments.check,
      "print the effective deck, the plan and the cost of one velocity evaluation, and stop; with Accuracy, also run two coarse levels, to "
      "predict the level that meets the requests");
  app.add_option("--resume", arguments.resume, "continue from the newest checkpoint in this directory")->check(directory, "");
  app.add_flag("--no-expect", arguments.no_expect, "report a missed Expect, and do not fail the run for it");
  app.add_flag("--reference", arguments.reference, "print the manual of every parameter (Markdown)");
  app.add_flag("--reference-series", arguments.reference_series, "print the manual of every series and field of the results (Markdown)");
  app.add_flag("--rejections", arguments.rejections, "print the table of all combinations of choices that are rejected, with reasons (Markdown)");
  app.add_flag("--schema", arguments.schema, "print a JSON schema of decks, by which editors complete keys and show their meaning");
  app.add_option("--new", arguments.new_deck, "print a commented deck of this kind: " + deck::alternatives(kinds_of_decks()))
      ->check(CLI::IsMember(kinds_of_decks()), "");
  app.add_flag("--cite", arguments.cite, "print what to cite for the features that the deck uses, or without a deck for all features, and stop");
  app.add_option("--threads", arguments.threads,
                 "number of threads of this process, or under mpirun of each rank (default: OMP_NUM_THREADS; if it is not set, the cores that the "
                 "ranks of a computer may use, divided by the number of these ranks). Results do not depend on it")
      ->check(CLI::Range(1, most_threads));
  app.add_flag("--quiet", arguments.quiet, "no progress bar, and no timed evaluation with --check");
  app.set_version_flag("--version", [] { return "tanktread " + provenance().at("version"); });
}

bool portable(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '='; }

std::string stem(const std::string& path) { return std::filesystem::path(path).stem(); }

/// Returns the default name of the results directory: `<deck>_<overlay>_<key>=<value>`, from file names without extensions and keys without their
/// sections. `_` replaces all characters except letters, digits and `.-=`. A name longer than 100 characters is cut and ends with a checksum of the
/// decks and settings.
std::string default_name(const std::vector<std::string>& decks, const std::vector<std::string>& settings) {
  constexpr std::size_t longest = 100;
  std::string laid_over;
  output::Checksum sum;
  for (const std::string& deck : decks) {
    sum.add(deck);
    if (&deck != &decks.front()) laid_over += "_" + stem(deck);
  }
  for (const std::string& setting : settings) {
    sum.add(setting);
    const std::size_t key = setting.substr(0, setting.find('=')).rfind('/') + 1;
    laid_over += "_" + setting.substr(key);
  }
  std::ranges::replace_if(laid_over, [](char c) { return !portable(c); }, '_');
  const std::string name = stem(decks.front()) + laid_over;
  if (laid_over.empty() || name.size() <= longest) return name;
  const std::string end = "_" + sum.digits();
  return name.substr(0, longest - end.size()) + end;
}

/// Reads `stored`, the deck of the checkpoint, into `scene`. Throws UserError if the deck `now` changes a key that may not change on resumption.
void check_changes(const std::string& stored, const deck::Document& now, Scene& scene) {
  deck::Document before = deck::read_text(stored, "The stored deck");
  before.declare(scene);
  auto old_values = before.values();
  for (const auto& [path, value] : now.values())
    if (old_values[path] != value && !may_change_on_resume(path))
      throw UserError(path + " cannot change when a run continues: it was " + (old_values[path].empty() ? "not set" : old_values[path]) +
                      ", and now is " + value + ".");
}

/// Reads and checks the scene of a deck given as text, in which `settings` replace the values of keys. Also reads the files that the deck names.
Scene scene_of(const std::string& text, const std::vector<std::string>& settings, const Arguments& arguments, const Registry& registry) {
  deck::Document deck = deck::read({}, settings, text);
  Scene scene(registry);
  prepare(deck, arguments, scene);
  return scene;
}

RunRequest run_request(const Arguments& arguments, const std::string& deck, const Registry& registry) {
  RunRequest request;
  request.resume = !arguments.resume.empty();
  request.output = request.resume             ? arguments.resume
                   : arguments.output.empty() ? "results/" + default_name(arguments.decks, arguments.settings)
                                              : arguments.output;
  request.overwrite = arguments.overwrite, request.quiet = arguments.quiet, request.deck_text = deck;
  request.changed = [=, &registry](const std::vector<std::string>& settings) { return scene_of(deck, settings, arguments, registry); };
  request.provenance = provenance();
  return request;
}

/// Prints a text on the first rank. Throws RunFailure on all ranks if that fails. Only this function may write to std::cout. Collective.
void print(bool speaks, const std::string& text) {
  coupling::together(speaks, [&] {
    if (!(std::cout << text).flush() || std::fflush(stdout) != 0 || std::ferror(stdout))
      throw RunFailure(std::string("cannot write to standard output: ") + std::strerror(errno));
  });
}

/// Runs the deck on finer and finer levels until the errors requested by the section Accuracy are reached. With `--check`, only prints the predicted
/// errors and levels. Returns the exit code.
int climb(const Scene& scene, const deck::Document& deck, Arguments arguments, const Registry& registry, bool speaks) {
  const RunRequest whole = run_request(arguments, deck.effective(), registry);
  if (!arguments.check) check_vacant(whole);
  accuracy::LadderRequest task{.options = scene.accuracy, .expect = scene.expect, .undefined = undefined_series(scene), .values = deck.values(),
                               .deck = whole.deck_text, .directory = whole.output, .resume = whole.resume, .overwrite = whole.overwrite,
                               .quiet = whole.quiet, .runs_in_time = scene.has_time()};
  accuracy::check_levels(task.values);
  std::string base = accuracy::without_section(accuracy::without_section(task.deck, "Accuracy"), "Expect");
  arguments.accuracy.clear();
  accuracy::Program program;
  program.deck = [&](const std::vector<std::string>& settings) {
    deck::Document level = deck::read({}, settings, base);
    Scene of_level(registry);
    prepare(level, arguments, of_level);
    return level.effective();
  };
  program.check_start = [&](const std::string& text) {
    const Scene of_level = scene_of(text, {}, arguments, registry);
    check_search(of_level, run_request(arguments, text, registry));
    check_start(of_level);
  };
  program.run = [&, start = Phases::Clock::now()](const std::string& text, const auto& directory, bool resume, std::optional<double> limit) {
    Scene of_level = scene_of(text, {}, arguments, registry);
    of_level.output.limit(start, limit);
    RunRequest request = run_request(arguments, text, registry);
    request.output = directory, request.resume = resume, request.overwrite = true, request.quiet = true, request.of_ladder = true;
    return simulate(of_level, request);
  };
  program.reason_of_stop = reason_of_stop;
  if (!arguments.check) return accuracy::climb(task, program);
  std::string text;
  for (const std::string& line : accuracy::forecast(task, program)) text += line + "\n";
  print(speaks, text);
  return Exit::done;
}

/// Returns the deck with which the run in this directory was started. Collective.
std::string deck_of_run(const std::string& directory) {
  const std::optional<std::string> ladder = accuracy::ladder_deck(directory);
  return ladder ? *ladder : stored_deck(directory);
}

/// Returns the text to print for an option that needs no deck (--reference, --schema, --new, ...), or nothing if no such option is given.
std::optional<std::string> text_without_deck(const Arguments& arguments, const Registry& registry) {
  if (arguments.reference)
    return "# Every key of a deck\n\nPrinted by `tanktread --reference`. A path such as Flow/shear rate names the key `shear rate` of the "
           "section Flow. x1, x2, x3 are Cartesian coordinates. Equation numbers, as (3.3), refer to [lib/README.md](../lib/README.md).\n\n" +
           deck::manual(Scene(registry));
  if (arguments.reference_series) return series_manual(registry);
  if (arguments.rejections) return "# Combinations that are rejected\n\nPrinted by `tanktread --rejections`.\n\n" + rejection_table(registry);
  if (arguments.schema) return deck::schema(Scene(registry));
  if (!arguments.new_deck.empty()) return new_deck(arguments.new_deck);
  if (arguments.cite && arguments.decks.empty() && arguments.resume.empty()) return citations(nullptr, provenance().at("version"));
  return std::nullopt;
}

int run(const Arguments& arguments, const Registry& registry, bool speaks) {
  if (const auto text = text_without_deck(arguments, registry)) {
    print(speaks, *text);
    return Exit::done;
  }
  const bool resume = !arguments.resume.empty();
  if (arguments.decks.empty() && !resume)
    throw UserError("No deck is given: tanktread [options] deck.yaml [overlay.yaml ...]; see --help.");
  const int cores = coupling::cores_per_rank();
  set_threads(arguments.threads.value_or(requested_threads(cores)));
  refuse(resume && !arguments.output.empty(), "--output", "--resume", "a run continues in its own directory");
  refuse(resume && arguments.overwrite, "--overwrite", "--resume", "--overwrite deletes the checkpoints from which --resume continues");

  const std::string stored = resume ? deck_of_run(arguments.resume) : std::string();
  std::vector<std::string> settings = arguments.settings;
  if (!arguments.accuracy.empty()) settings.push_back(accuracy::setting_of(arguments.accuracy));
  Scene scene(registry), before(registry);
  deck::Document deck = deck::read(arguments.decks, settings, stored, arguments.no_expect ? "--no-expect" : "");
  prepare(deck, arguments, scene);
  if (resume) check_changes(stored, deck, before);
  if (arguments.cite) {
    print(speaks, citations(&scene, provenance().at("version")));
    return Exit::done;
  }
  coupling::try_solvers(scene.solvers, scene.steady.present ? scene.steady.method : scene.time.nonlinear_solver);
  for (const auto& sentences : {check_expectations(scene), scene.idle_keys, std::vector{coupling::crowding()}})
    for (const std::string& sentence : sentences)
      if (speaks && !sentence.empty()) std::cerr << "tanktread: warning: " << sentence << std::endl;
  accuracy::check_series(scene.accuracy.requests, names_of_series(scene));

  RunRequest request = run_request(arguments, deck.effective(), registry);
  if (arguments.check) {
    check_room(scene);
    check_search(scene, request);
    output::Entries<std::string> lines = plan(scene, coupling::Ranks().size());
    if (!arguments.quiet) std::ranges::move(evaluation_cost(scene), std::back_inserter(lines));
    print(speaks, deck.effective() + "\n" + plan_text(lines));
    return scene.accuracy.present ? climb(scene, deck, arguments, registry, speaks) : static_cast<int>(Exit::done);
  }
  if (scene.accuracy.present) return climb(scene, deck, arguments, registry, speaks);
  request.another_scheme = resume && before.time.scheme != scene.time.scheme;
  return simulate(scene, request);
}

/// Returns the message as one line of at most 1000 bytes.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return deck::shortened(text, 1000);
}

/// Runs the program on one rank, and returns the exit code. Prints only if `speaks` is true, as on the first rank. `message` receives the error.
int guarded(int argc, char** argv, const Registry& registry, bool speaks, std::string& message) {
  const auto report = [speaks, &message](const char* text, int code) {
    message = one_line(text);
    if (speaks) std::cerr << "tanktread: " << message << std::endl;
    return code;
  };
  Arguments arguments;
  try {
    CLI::App app("Deformable capsules and drops in viscous flow, by isogeometric boundary elements.", "tanktread");
    declare_options(app, arguments);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) return report(error.what(), Exit::mistake);
      std::ostringstream text;
      app.exit(error, text, text);  // --help, --version
      print(speaks, text.str());
      return Exit::done;
    }
    return run(arguments, registry, speaks);
  } catch (const Stopped&) {
    const std::string what = arguments.resume.empty() ? " before any results were written"
                                                      : " before its first step; --resume " + arguments.resume + " continues the run";
    return report((spoken(reason_of_stop()) + what).c_str(), Exit::stopped);
  } catch (const UserErrors& errors) {
    for (const std::string& sentence : errors.all) report(sentence.c_str(), Exit::mistake);
    message = one_line(errors.what());
    return Exit::mistake;
  } catch (const UserError& error) {
    return report(error.what(), Exit::mistake);
  } catch (const std::exception& error) {
    return report(error.what(), Exit::failed);
  }
}

/// Keeps freed memory for later steps and snapshots. The operating system would clear returned memory at each new allocation, which costs time.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 25);
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
#endif
}

}  // namespace

int main(int argc, char** argv, const Registry& registry) {
  keep_freed_memory();
  catch_signals();
  const coupling::Session session(&argc, &argv);
  std::string message;
  const int code = guarded(argc, argv, registry, session.rank() == 0, message);
  coupling::leave_together(code, message);
  return code;
}

}  // namespace tanktread
