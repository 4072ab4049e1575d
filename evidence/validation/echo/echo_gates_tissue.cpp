// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

std::shared_ptr<const Scene> muscle_block() {
  const std::array<FlatLayer, 1> block{{{"muscle", 60e-3}}};
  return make_block_scene(block);
}

std::shared_ptr<const Scene> lossless_block(const std::string& tissue) {
  const std::array<FlatLayer, 1> block{{{tissue, 60e-3}}};
  return make_block_scene(
      block, [&](CompiledJoint& joint) { acoustic_of(joint, tissue).attenuation = 0; });
}

/// Envelopes one per resolution cell, from several independent bodies.
std::vector<double> independent_envelopes() {
  std::vector<double> cells;
  const auto scene = lossless_block("muscle");
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    ImageSettings settings = bare_settings();
    settings.seed = seed;
    Renderer renderer(scene, Transducer{}, settings);
    const Frame& frame = renderer.render(Pose::Identity());
    for (int l = 6; l < frame.n_lines - 6; l += 4) {
      const auto line = envelope_line(frame, l);
      for (std::size_t i = 40; i + 20 < line.size(); i += 12) cells.push_back(line[i]);
    }
  }
  return cells;
}

Plot envelope_histogram(const std::vector<double>& cells, double rms) {
  constexpr int kBins = 60;
  constexpr double kBin = 3.0 / kBins;  // in rms
  std::vector<double> counts(kBins, 0);
  for (const double a : cells) {
    const auto bin = static_cast<std::size_t>(a / rms / kBin);
    if (bin < counts.size()) counts[bin] += 1;
  }
  PlotSeries measured{"rendered", {}, {}, PlotStyle::points};
  PlotSeries rayleigh{"Rayleigh", {}, {}};
  for (int i = 0; i < kBins; ++i) {
    const double x = (i + 0.5) * kBin;
    measured.x.push_back(x);
    measured.y.push_back(counts[static_cast<std::size_t>(i)] /
                         (static_cast<double>(cells.size()) * kBin));
    rayleigh.x.push_back(x);
    rayleigh.y.push_back(2 * x * std::exp(-x * x));
  }
  return {"envelope of a homogeneous block",
          {{"envelope over its rms", "density", {measured, rayleigh}}}};
}

/// Mean level (dB) of the echo of an interface 10 mm deep between two silent tissues.
double interface_level(const std::string& above, const std::string& below) {
  const std::array<FlatLayer, 2> layers{{{above, 10e-3}, {below, 30e-3}}};
  Renderer renderer(make_block_scene(layers, silence), Transducer{}, bare_settings());
  const Frame& frame = renderer.render(Pose::Identity());
  constexpr int kFirst = 20;
  constexpr int kLast = 236;
  double sum = 0;
  for (int l = kFirst; l < kLast; ++l) sum += peak_value(frame, l, 8e-3, 12e-3);
  return decibel(sum / (kLast - kFirst));
}

double step_level(const std::string& above, const std::string& below) {
  const std::array<FlatLayer, 2> layers{{{above, 1e-3}, {below, 1e-3}}};
  const auto scene = make_block_scene(layers);
  const double a = scene->joint().tissue_of(kFirstRegion).acoustic.impedance();
  const double b = scene->joint().tissue_of(kFirstRegion + 1).acoustic.impedance();
  return decibel(std::abs(b - a) / (b + a));
}

double mean_level(const std::string& tissue, double tilt) {
  const std::array<FlatLayer, 1> block{{{tissue, 60e-3}}};
  const auto scene = make_block_scene(block, [&](CompiledJoint& joint) {
    acoustic_of(joint, tissue).attenuation = 0;
    joint.regions.back().fibre_axis = Vec3(std::cos(tilt), 0, std::sin(tilt));
  });
  Renderer renderer(scene, Transducer{}, bare_settings());
  return decibel_of_intensity(mean_intensity(renderer.render(Pose::Identity()), 5e-3, 35e-3));
}

}  // namespace

Gate gate_speckle() {
  Gate gate;
  gate.title = "Fully developed speckle in a homogeneous block (Rayleigh: mean/sd 1.913, 5.57 dB)";
  const std::vector<double> cells = independent_envelopes();
  const Moments envelope = moments_of(cells);
  std::vector<double> levels;
  double squares = 0;
  for (const double a : cells) {
    levels.push_back(decibel(a));
    squares += a * a;
  }
  const auto n = static_cast<double>(cells.size());
  gate.claims.push_back(claim_at_least(ClaimKind::input, "resolution cells", n, 1e4, ""));
  gate.claims.push_back(claim_within(ClaimKind::independent, "envelope mean over sd",
                                     envelope.mean / envelope.deviation, 1.91, 0.05, ""));
  gate.claims.push_back(claim_within(ClaimKind::independent, "sd of the dB image",
                                     moments_of(levels).deviation, 5.57, 0.2, "dB"));
  gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                      "Kolmogorov-Smirnov distance to Rayleigh (1 % level)",
                                      rayleigh_distance(cells), 1.63 / std::sqrt(n), ""));
  gate.plots.push_back({"", envelope_histogram(cells, std::sqrt(squares / n))});
  const auto phantom = make_echo_phantom("homogeneous");
  add_picture(gate, "homogeneous",
              annotated_image(render_bmode(phantom->scene, phantom->X_JP), Transducer{}));
  return gate;
}

Gate gate_attenuation() {
  Gate gate;
  const double attenuation = 0.75;  // dB/cm/MHz, muscle of the library
  gate.title = "Fall of muscle's speckle with depth, twice 0.75 dB/cm/MHz at 12 MHz, no downshift";
  Renderer renderer(muscle_block(), Transducer{}, bare_settings());
  const Frame& frame = renderer.render(Pose::Identity());
  PlotSeries measured{"rendered", {}, {}, PlotStyle::points};
  std::vector<double> depths;
  for (int k = 0; k < 32; ++k) {
    const double z = 3e-3 + 1e-3 * k;
    // The mean intensity against true depth (the display shows it at 1540 m/s).
    depths.push_back((z + 0.5e-3) * 1562 / kDisplaySpeedOfSound * 100);  // cm
    measured.x.push_back(depths.back() * 10);
    measured.y.push_back(decibel_of_intensity(mean_intensity(frame, z, z + 1e-3)));
  }
  const LineFit fit = fit_line(depths, measured.y);
  gate.claims.push_back(claim_near(ClaimKind::input, "slope, two-way", -fit.slope,
                                   2 * attenuation * 12, 0.02, "dB/cm"));
  PlotSeries line{"fit", {}, {}};
  for (const double cm : depths) {
    line.x.push_back(cm * 10);
    line.y.push_back(fit.intercept + fit.slope * cm);
  }
  gate.plots.push_back(
      {"", {"speckle level of muscle", {{"depth, mm", "dB below a mirror", {measured, line}}}}});
  return gate;
}

Gate gate_matched_impedance() {
  Gate gate;
  gate.title = "Skin and muscle of one impedance 10 mm deep: nothing above the speckle";
  const std::array<FlatLayer, 2> layers{{{"muscle", 10e-3}, {"skin", 30e-3}}};
  const auto scene = make_block_scene(layers, [](CompiledJoint& joint) {
    acoustic_of(joint, "muscle").attenuation = 0;
    const Acoustic muscle = acoustic_of(joint, "muscle");
    Acoustic& skin = acoustic_of(joint, "skin");  // keeps its kind: two muscles have a fascia
    skin.speed_of_sound = muscle.speed_of_sound;
    skin.density = muscle.density;
    skin.attenuation = muscle.attenuation;
    skin.backscatter = muscle.backscatter;
  });
  Renderer renderer(scene, Transducer{}, bare_settings());
  const Frame& frame = renderer.render(Pose::Identity());
  const double at = mean_intensity(frame, 9.6e-3, 10.1e-3);
  const double above = mean_intensity(frame, 5e-3, 9e-3);
  gate.claims.push_back(claim_at_most(ClaimKind::input,
                                      "intensity at the interface over the speckle above it",
                                      decibel_of_intensity(at / above), 1, "dB"));
  return gate;
}

Gate gate_interfaces() {
  Gate gate;
  gate.title = "Perpendicular echo levels of tissue pairs, 10 mm deep, no loss";
  gate.assumed = {"density of stainless steel, 7900 kg/m3; speed and density of cortical bone"};
  struct Pair {
    const char* above;
    const char* below;
    double expected;  // dB
  };
  for (const Pair& pair :
       {Pair{"fat", "muscle", -20}, Pair{"muscle", "bone", -5}, Pair{"muscle", "steel", -0.6}}) {
    gate.claims.push_back(
        claim_within(ClaimKind::input, std::string(pair.above) + " - " + pair.below,
                     interface_level(pair.above, pair.below), pair.expected, 1, "dB"));
  }
  for (const auto& [above, below] :
       {std::pair("skin", "fat"), {"muscle", "tendon"}, {"tendon", "bone"}, {"muscle", "air"}}) {
    gate.claims.push_back(
        claim_within(ClaimKind::input, std::string(above) + " - " + below + ", impedance step",
                     interface_level(above, below), step_level(above, below), 1, "dB"));
  }
  const auto phantom = make_echo_phantom("layers");
  add_picture(gate, "layers",
              annotated_image(render_bmode(phantom->scene, phantom->X_JP), Transducer{}));
  return gate;
}

Gate gate_fat_shift() {
  Gate gate;
  gate.title = "10 mm of fat (1462 m/s) over bone: shown 0.53 mm too deep";
  const std::array<FlatLayer, 2> layers{{{"fat", 10e-3}, {"bone", 30e-3}}};
  Renderer renderer(make_block_scene(layers, silence), Transducer{}, bare_settings());
  const Frame& frame = renderer.render(Pose::Identity());
  const double shown = find_peak(frame, 128, 8e-3, 12e-3) * frame.sample_depth;
  gate.claims.push_back(claim_within(ClaimKind::input, "displacement, one sample allowed",
                                     (shown - 10e-3) / kMillimetre, 0.53,
                                     frame.sample_depth / kMillimetre, "mm"));
  return gate;
}

Gate gate_enhancement() {
  Gate gate;
  gate.title =
      "5 mm of bursal or injected fluid in tissue of 0.7 dB/cm/MHz at 12 MHz: + 2 alpha f t behind "
      "it";
  gate.assumed = {
      "speed of fluids, 1500-1540 m/s, and attenuation of bursal fluid, 0.05 dB/cm/MHz (injected "
      "fluid: that of water, [Pinkerton1949])"};
  const auto level = [](const char* middle) {
    const std::array<FlatLayer, 3> layers{{{"muscle", 5e-3}, {middle, 5e-3}, {"muscle", 40e-3}}};
    const auto scene = make_block_scene(layers, [](CompiledJoint& joint) {
      for (const char* name : {"muscle", "bursa", "fluid"}) {
        acoustic_of(joint, name).speed_of_sound = 1540;
        acoustic_of(joint, name).density = 1000;
      }
      acoustic_of(joint, "muscle").attenuation = 70 / kDecibelPerNeper;
    });
    Renderer renderer(scene, Transducer{}, bare_settings());
    return mean_intensity(renderer.render(Pose::Identity()), 14e-3, 24e-3);
  };
  for (const char* fluid : {"bursa", "fluid"})
    gate.claims.push_back(claim_within(ClaimKind::input, std::string("enhancement behind ") + fluid,
                                       decibel_of_intensity(level(fluid) / level("muscle")), 8.4, 1,
                                       "dB"));
  const auto phantom = make_echo_phantom("cyst");
  add_picture(gate, "cyst",
              annotated_image(render_bmode(phantom->scene, phantom->X_JP), Transducer{}));
  return gate;
}

Gate gate_tendon() {
  Gate gate;
  gate.title = "Tendon against muscle by the beam's tilt from perpendicular ([Crass1988])";
  gate.assumed = {
      "backscatter of tendon, 5.1 dB above muscle, chosen with the published range in view, and "
      "its "
      "floor 25 dB down; the lobe itself follows from the aperture"};
  PlotSeries tendon{"tendon", {}, {}, PlotStyle::line_points};
  PlotSeries muscle{"muscle", {}, {}, PlotStyle::line_points};
  std::vector<double> above;
  for (int degrees = 0; degrees <= 30; ++degrees) {
    for (PlotSeries* series : {&tendon, &muscle}) {
      series->x.push_back(degrees);
      series->y.push_back(mean_level(series->label, degrees * kDegree));
    }
    above.push_back(tendon.y.back() - muscle.y.back());
  }
  const ClaimBasis of_the_level(ClaimKind::fitted, "tendon's level was chosen by the range");
  gate.claims.push_back(claim_at_least(of_the_level, "tendon over muscle when perpendicular",
                                       above.front(), 0, "dB"));
  gate.claims.push_back(claim_within(of_the_level, "tilt at which both are equal",
                                     falls_to(tendon.x, above, 0), 4.5, 2.5, "degrees"));
  gate.claims.push_back(claim_at_least({ClaimKind::fitted, "the floor, 25 dB down, is assumed"},
                                       "tendon's loss within 20 degrees of tilt",
                                       tendon.y.front() - tendon.y[20], 10, "dB"));
  gate.plots.push_back(
      {"", {"tendon and muscle", {{"tilt, degrees", "speckle, dB", {tendon, muscle}}}}});
  return gate;
}

}  // namespace artus
