// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/manual/keys.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "slicer/model/effects/catalogue.h"
#include "slicer/model/effects/covariate.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {
namespace {

using Keys = std::vector<Key>;

Keys operator+(Keys a, const Keys& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The same keys within another object or list.
Keys within(const std::string& outer, const Keys& keys) {
  Keys out;
  for (const Key& key : keys) out.push_back({outer + "." + key.name, key.meaning});
  return out;
}

KeyTable result(const Keys& keys) {
  return {"RESULT", "With --json the result is one object on stdout:", keys};
}

Keys faults() {
  return {{"lost", "number of features of the target of which nothing is printed"},
          {"fused", "number of gaps of the target that are printed solid"},
          {"spurious", "number of printed crumbs where the target has nothing"},
          {"loose", "number of printed pieces that nothing holds to their part"},
          {"joined", "number of bridges between parts that are apart"}};
}

Keys place_of_fault() {
  return {
      {"kind",
       "lost, fused, spurious, loose, joined, or trapped: powder without a way out; check: also "
       "thin or narrow, by the profile's [strength]"},
      {"at_mm", "its middle on the bed: x, y, z in mm"},
      {"size_mm", "its extent along x, y and z, mm"},
      {"layers", "its first layer, and the layer after its last"},
      {"voxels", "its volume in voxels"},
      {"volume_mm3", "its volume in cubic mm"}};
}

Keys wrong_place() {
  return {{"kind", "what is wrong: lost, fused, or else missing (too thin) or extra (too thick)"},
          {"at_mm", "its place on the bed: x, y, z in mm"},
          {"layer", "its layer"},
          {"depth_mm", "its distance from the target's surface, mm; 2 stands for 2 or more"}};
}

Keys edge_errors() {
  return {
      {"mean", "distance of the edges from where they should be, mean over all edges, mm"},
      {"p95", "the distance that 95 % of the edges do not exceed, mm"},
      {"max", "the largest distance, mm; 2 where no edge is found within 2 mm, as in the others"}};
}

Keys score_sheet() {
  return Keys{{"solid_voxels", "number of voxels of the target"},
              {"wrong", "voxels in which print and target differ, as a share of solid_voxels"},
              {"floor",
               "the part of wrong that no mask avoids, as one mask serves a layer's slices"},
              {"excess", "wrong - floor"},
              {"window_excess.mean", "excess if the printer is a little off its profile: the mean"},
              {"window_excess.worst", "and the worst over the process window"}} +
         Keys{{"depth_mm.p999",
               "the distance from the target's surface, mm, that 99.9 % of the wrong voxels do not "
               "exceed; without those that no mask avoids"},
              {"depth_mm.worst", "that of the deepest"},
              {"depth_mm.searched", "a distance of this much, mm, stands for this much or more"},
              {"deepest", "where the deepest wrong voxel is; null if none is wrong"}} +
         within("deepest", wrong_place()) + within("epe_mm", edge_errors()) + faults() +
         Keys{{"mask.least_island_px", "the smallest island of a mask, in pixels; null if none"},
              {"mask.least_hole_px", "the smallest hole of a mask, in pixels; null if none"}};
}

Keys sent() {
  return {{"job", "the job's number at the printer or spool"},
          {"to", "where it was sent"},
          {"layers", "number of layers of the whole job"},
          {"first_layer_sent", "the first layer of this call; above 0 where a job was resumed"},
          {"bytes_sent", "size of what was sent, bytes"},
          {"seconds", "how long that took, s"},
          {"printed", "emulator: alone: the folder of what it printed"}};
}

Keys job_status() {
  return {{"job", "the job's number"},
          {"state", "incoming: being sent; held: stopped, can be resumed; done"},
          {"layers", "number of layers"},
          {"acknowledged", "layers 0 to acknowledged - 1 are safe"},
          {"name", "the name of the file it came from"},
          {"source", "the path of that file, or empty"},
          {"reason", "why it is held, or empty"}};
}

Keys print_estimate() {
  return {{"print_minutes", "how long printing and drying take, minutes"},
          {"binder_ml", "binder that the printer uses, ml"}};
}

KeyTable stack_json(const std::string& about) {
  return {"STACK.JSON",
          about,
          {{"format", "slice-stack"},
           {"version", "1"},
           {"kind", "mask, target, printed, measured or color"},
           {"size", "columns, rows and number of images"},
           {"pitch_mm", "extent of a sample along x, y and z, mm"},
           {"origin_mm", "lower corner of the first sample on the bed: x, y, z in mm"},
           {"files", "the images' names, with the number of the image as %06d"},
           {"first", "the number of the first image"},
           {"threshold", "an 8-bit sample is solid from here on; 128 where it is not given"}}};
}

Keys covariate() {
  Keys keys = {{"axis",
                "what the effect follows: x, y, z, layer, direction, density, facing, "
                "edge_distance, position; empty: the same everywhere"},
               {"form", "how: trend, periodic, step, window or local"}};
  for (const CovariateNumber& number : covariate_numbers()) {
    keys.push_back({number.name, number.meaning});
  }
  return keys;
}

Keys print_error() {
  return Keys{{"wrong", "voxels in which model and print differ, as a share of the print"},
              {"excess", "wrong less what two prints of one job differ by"}} +
         within("epe_mm", edge_errors());
}

Keys found_effects() {
  return Keys{{"kind",
               "a kind of binderjet-profile(1), empirical where none fits, or for gauges "
               "the number of the model that changes"},
              {"parameters.NAME",
               "its numbers, named as in a profile; for gauges value, the best, "
               "and from and to, between which all gauges agree, or for lengths "
               "mm of each batch, column or axis"}} +
         within("covariate", covariate()) +
         Keys{{"rivals[]", "kinds that explain the print as well"},
              {"p", "how often chance alone finds as much; null where so few readings cannot say"},
              {"heldout_gain",
               "share of the residual gone in the cells that the fit did not see, or, of what "
               "moves no edge, of the wrong voxels"}};
}

std::vector<KeyTable> calibrate_tables() {
  const KeyTable printed = {
      "RESULT",
      "With --json the result is one object on stdout, the same as calibration.json in the output "
      "folder. With --job it has:",
      Keys{{"format", "calibration"},
           {"version", "1"},
           {"verdict",
            "effect: named ones were found; none: nothing is missing; unexplained: the print is "
            "not as predicted, and nothing with a name explains it"}} +
          within("effects[]", found_effects()) +
          Keys{{"remaining", "what the residual that is left follows most, or null"}} +
          within("remaining", covariate()) +
          Keys{{"remaining.share", "its share of the residual that is left"},
               {"data", "which layers before and after are measured on"}} +
          within("before", print_error()) + within("after", print_error()) +
          Keys{{"floor", "two prints of the job against each other; null with one print"}} +
          within("floor", print_error()) +
          Keys{{"scores[].data", "which layers: those held out, or of the check job"}} +
          within("scores[].before", print_error()) + within("scores[].after", print_error()) +
          Keys{{"profile", "the file with the calibrated model; empty or null if none was written"},
               {"report", "the file with the report for a person"}}};
  const KeyTable gauges = {
      "RESULT WITH GAUGES",
      "With --gauges it has format, version, verdict, effects, profile and report as above, and:",
      {{"readings[].gauge", "what was read, of slots and walls"},
       {"readings[].measured_mm", "the width, or the first that shows, mm"},
       {"readings[].uncertainty_mm", "how far that may be off, mm"},
       {"readings[].declared_mm", "what the declared model predicts, mm"},
       {"readings[].residual_mm", "measured less declared, mm"},
       {"readings[].after_mm", "what the calibrated model predicts, mm"},
       {"readings[].residual_after_mm", "measured less that, mm"},
       {"effects[].rivals[].kind", "another number of the model that explains the readings"},
       {"effects[].rivals[].value", "its best value"},
       {"effects[].rivals[].from", "the least value that agrees with all gauges"},
       {"effects[].rivals[].to", "the largest value that agrees with all gauges"},
       {"effects[].rivals[].text", "the same in words"},
       {"tell_apart[].gauge", "a gauge to print that tells the first two explanations apart"},
       {"tell_apart[].predicted_mm", "how wide each of them says it comes out, mm"},
       {"tell_apart[].difference_mm", "how far these are apart, mm"},
       {"before.rms_mm", "root mean square of the errors of the readings, declared model, mm"},
       {"before.median_mm", "median of the absolute errors of lengths, mm"},
       {"after.rms_mm", "the same after, each reading predicted from the others, mm"},
       {"after.median_mm", "median after, likewise, mm"},
       {"after.fitted_rms_mm", "root mean square after, on the readings fitted, mm"},
       {"floor.rms_mm", "what readings of one length differ by, mm; 0 if each was read once"},
       {"ladder[].model", "a term that was tried for the error of lengths"},
       {"ladder[].form", "the form of it that fits best"},
       {"ladder[].parameters", "how many numbers the model has with it"},
       {"ladder[].rms_mm", "root mean square of the errors with it, held out by part, mm"},
       {"ladder[].median_mm", "median of the absolute errors, held out by part, mm"},
       {"ladder[].t", "Student's t of its gain over the parts"},
       {"ladder[].p", "two-sided probability of that by chance"},
       {"ladder[].heldout_gain", "share of the squared error that it takes away"},
       {"ladder[].accepted", "whether it is kept"},
       {"rows", "number of rows of the table"},
       {"used_rows", "number of rows that were used"},
       {"dropped[]", "what was left out, and why"},
       {"offset_batches", "number of batches that grew by an offset rather than by a scale"},
       {"batches", "number of batches"}}};
  const KeyTable columns = {
      "GAUGES.CSV",
      "The table of --gauges has a header line with one of three sets of columns; lines that begin "
      "with # are remarks. Slots seen on a block: axis, first_visible_slot_mm_low, "
      "first_visible_slot_mm_high. Slots and walls: gauge, axis, nominal_mm and visible or "
      "measured_mm. Lengths: nominal_x and meas_x, likewise y and z.",
      {{"axis", "x, y or z: what the slot or wall is measured along"},
       {"first_visible_slot_mm_low", "the narrowest slot that may have been seen, mm"},
       {"first_visible_slot_mm_high", "the narrowest slot that was certainly seen, mm"},
       {"gauge", "slot or wall"},
       {"nominal_mm", "its width in the model, mm"},
       {"visible", "1 if it shows on the print, 0 if not"},
       {"measured_mm", "its width on the print, mm"},
       {"uncertainty_mm", "how far measured_mm may be off, mm"},
       {"nominal_x, nominal_y, nominal_z", "length of a block in the model, mm"},
       {"meas_x, meas_y, meas_z", "length of it on the print, mm"},
       {"batch", "which print the block is from; optional"},
       {"part", "the block's number within the batch; optional"},
       {"rep", "which reading of the same block this is; optional"},
       {"pos_x_mm, pos_y_mm", "where the block lay on the bed, mm; optional"}}};
  return {printed, gauges, columns,
          stack_json("A stack of --job or --measured is a folder with images and stack.json:")};
}

// "width_mm: 2 numbers, above 0, at most 20".
std::string parameters_of(const EffectKind& kind) {
  std::string text;
  const auto add = [&text](const std::string& one) { text += (text.empty() ? "" : "; ") + one; };
  for (const WordRule& rule : kind.words) {
    add(fmt::format("{}: {}", rule.name, fmt::join(rule.allowed, " or ")));
  }
  for (const NumberRule& rule : kind.numbers) {
    add(fmt::format("{}: {} {:.4g} to {:.4g}{}", rule.name,
                    rule.count == 1 ? "" : fmt::format("{} numbers,", rule.count), rule.min,
                    rule.max, rule.optional ? ", optional" : ""));
  }
  return text.empty() ? "no parameters" : text;
}

KeyTable effects() {
  KeyTable table = {"EFFECTS", "The kinds of effects, with their parameters and their bounds:", {}};
  for (const EffectKind& kind : effect_kinds()) {
    table.keys.push_back({kind.name, parameters_of(kind)});
  }
  return table;
}

std::vector<KeyTable> profile_tables() {
  return {
      result({{"profiles[].name", "list: the name that -p takes"},
              {"profiles[].path", "list: the file"},
              {"name", "show and check: the printer's name"},
              {"path", "the file"},
              {"source", "where its numbers come from"},
              {"dpi", "pixels per inch along x and y"},
              {"layer_mm", "the layer heights that it prints, mm; the first is the default"},
              {"detail_vx", "voxels per pixel along x and y, and per layer along z"},
              {"bed_mm", "the bed's size along x, y and z, mm"},
              {"effects[].kind", "a kind of the table below"},
              {"effects[].NAME", "a parameter of the kind, of the table below"},
              {"strength.thinnest_mm",
               "check's rule of thumb for walls and pins, mm; absent where the profile has none"},
              {"strength.narrowest_mm", "the same for slots and holes, mm"},
              {"protocol", "how the printer is spoken to"}}),
      effects()};
}

const std::map<std::string, std::vector<KeyTable> (*)()>& pages() {
  static const std::map<std::string, std::vector<KeyTable> (*)()> all = {
      {"slice",
       [] {
         return std::vector{
             result(Keys{{"job", "the file that was written"},
                         {"layers", "number of layers written"},
                         {"kept_layers", "how many of them an interrupted slice had left"},
                         {"size_px", "the job's box: pixels along x and y, layers"},
                         {"solid_voxels", "number of voxels of the target"},
                         {"mask_pixels", "number of pixels that get binder"},
                         {"seconds", "how long slicing took, s; the rest of it, if interrupted"},
                         {"peak_rss_mb", "the most memory that it held, MB"}} +
                    print_estimate() + Keys{{"warnings[]", "what a person should know"}})};
       }},
      {"export",
       [] {
         return std::vector{
             result(
                 {{"outputs[].out", "a folder or file that was written"},
                  {"outputs[].what",
                   "what it holds: mask, color, target, printed, cmy, cuberille, html, 3mf, zip"},
                  {"out", "the only output, where there is one"},
                  {"what", "what that holds"},
                  {"layers", "number of layers"}}),
             stack_json("Each folder of images has stack.json:"),
             KeyTable{"META.JSON",
                      "In the archive of --zip, as NanoDLP reads it:",
                      {{"FormatVersion", "1"},
                       {"Distro", "generic"},
                       {"Program", "binderjet"},
                       {"Version", "the version of binderjet"},
                       {"OS", "linux"},
                       {"Arch", "any"},
                       {"Profile", "false: no profile is inside"}}}};
       }},
      {"simulate",
       [] {
         return std::vector{result({{"out", "the folder that was written"},
                                    {"layers", "number of layers"},
                                    {"profile", "the name of the printer"}}),
                            stack_json("The folder of images has stack.json:")};
       }},
      {"score",
       [] {
         return std::vector{
             result(score_sheet() +
                    Keys{{"compare.NAME",
                          "with --compare, the same of the masks that none, paper and inverse "
                          "make: compare.none.wrong and so on"}}),
             KeyTable{"FEATURES.JSON",
                      "In the folder of --map, the faults with their places, the largest first:",
                      Keys{{"format", "features"},
                           {"version", "1"},
                           {"lost", "number of features lost"},
                           {"fused", "number of gaps fused"},
                           {"spurious", "number of spurious crumbs"},
                           {"listed", "number of faults in the list"}} +
                          within("features[]", place_of_fault())},
             stack_json("The folder of --map has stack.json:")};
       }},
      {"explain",
       [] {
         return std::vector{result(
             {{"pixel", "x, y and layer"},
              {"on", "whether it gets binder"},
              {"target_share", "share of its voxels that are target"},
              {"level", "the dose from which on powder binds"},
              {"dose[]", "dose of its voxels, 0 to 1, row by row"},
              {"dose_flipped[]", "dose of them with the pixel in the other state"},
              {"wrong_if_flipped", "voxels that the other state would make wrong; below 0: right"},
              {"wrong_if_flipped_window", "the same, weighted over the process window"},
              {"rules_allow_flip", "whether the profile's mask rules allow the other state"}})};
       }},
      {"check",
       [] {
         return std::vector{result(
             Keys{
                 {"verdict",
                  "nothing to print, doubtful size, nothing of it prints, prints as it is, or what "
                  "goes wrong: loses detail, closes gaps, leaves crumbs, comes apart, joins parts "
                  "that are apart, is too thin (too thick) in places, may break, keeps powder "
                  "inside; several as a person would list them"}} +
             faults() +
             Keys{{"trapped", "number of pockets that trap powder"},
                  {"thin",
                   "number of places thinner than the profile's [strength] thinnest_mm; null "
                   "where it has none or none that this grid can tell"},
                  {"narrow", "number of gaps below its narrowest_mm; null as thin"}} +
             within("found[]", place_of_fault()) +
             Keys{{"found[].widest_mm", "thin and narrow: the width at its thickest, mm"}} +
             within("worst_places[]", wrong_place()) +
             Keys{{"excess",
                   "wrong voxels beyond the layers' height, as a share of the "
                   "part's"}} +
             print_estimate() +
             Keys{{"powder_ml", "powder that goes with the part, ml"},
                  {"warnings[]", "what a person should know"}})};
       }},
      {"coupon",
       [] {
         return std::vector{
             result({{"out", "the file that was written"}, {"triangles", "number of triangles"}})};
       }},
      {"calibrate", calibrate_tables},
      {"join",
       [] {
         return std::vector{result({{"job", "the file that was written"},
                                    {"shares", "number of shares"},
                                    {"layers", "number of layers"}})};
       }},
      {"print", [] { return std::vector{result(sent())}; }},
      {"resume", [] { return std::vector{result(sent())}; }},
      {"emulator",
       [] {
         return std::vector{
             result({{"out", "the folder that the printer was in"},
                     {"jobs[].job", "a job's number"},
                     {"jobs[].done", "whether all of it was printed"},
                     {"jobs[].layers", "number of layers that were printed"},
                     {"jobs[].printed", "the folder of what it printed, or null"}}),
             stack_json("The folder of what a job printed is a measured stack, with stack.json:")};
       }},
      {"status",
       [] {
         KeyTable table = result(job_status() + within("jobs[]", job_status()));
         table.about =
             "With --json the result is one object on stdout: of one job, or a list of "
             "jobs where none is named:";
         return std::vector{table};
       }},
      {"cancel",
       [] {
         return std::vector{result({{"job", "the job's number"},
                                    {"cancelled", "true"},
                                    {"seconds", "how long that took, s"}})};
       }},
      {"devices",
       [] {
         return std::vector{result({{"devices[].uri", "what --to takes"},
                                    {"devices[].description", "maker and model"},
                                    {"devices[].state", "idle, processing or stopped"}})};
       }},
      {"profile", profile_tables},
  };
  return all;
}

}  // namespace

std::vector<KeyTable> key_tables(const std::string& verb) {
  const auto page = pages().find(verb);
  return page == pages().end() ? std::vector<KeyTable>() : page->second();
}

}  // namespace binderjet
