// SPDX-License-Identifier: AGPL-3.0-or-later
// Every parameter of probe, image and needle is changed by 5 %, one at a time, in small pictures
// that between them use every stage of the image: each must be noticed.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/image_fields.h"
#include "artus/echo/renderer.h"
#include "tests/mutations/mutations.h"
#include "tests/support/layered_body.h"

namespace artus::test {

struct EchoSetup {
  Transducer transducer;
  ImageSettings image;
  NeedleShape needle;
};
ARTUS_FIELDS(EchoSetup, transducer, image, needle);

namespace {

std::shared_ptr<const Scene> block() {
  const std::array<FlatLayer, 5> layers{
      {{"skin", 1.5e-3}, {"fat", 3e-3}, {"muscle", 8e-3}, {"tendon", 4e-3}, {"bone", 10e-3}}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(make_layered_block(layers, 60e-3, 40e-3)));
}

EchoSetup small_picture() {
  EchoSetup setup;
  setup.transducer.width = 20e-3;
  setup.transducer.n_lines = 32;
  setup.image.depth = 24e-3;
  setup.image.n_samples = 192;
  setup.image.n_planes = 3;
  setup.image.pixel = 0.4e-3;
  setup.image.n_threads = 1;
  // far enough apart that each can rise and fall
  setup.image.grey_curve.grey = {0.02, 0.075, 0.175, 0.335, 0.565, 0.785, 0.825, 0.875, 0.95};
  setup.image.texture = false;  // most of a small picture's time, and made anew for each change
  return setup;
}

std::string cell(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// Two pictures, the second 0.3 mm to the side: dB to a hundredth every 7th sample of every 5th
/// line, its velocity, and the grey of every 5th pixel of every 5th row.
std::vector<std::string> picture_lines(const Scene& scene, EchoSetup setup, double gap) {
  if (setup.image.compound_angles % 2 == 0) ++setup.image.compound_angles;  // odd: 3 becomes 5
  if (setup.transducer.radius > 0) setup.image.compound_angles = 1;  // of linear probes alone
  EXPECT_TRUE(validate(setup.transducer));
  EXPECT_TRUE(validate(setup.image));
  Renderer renderer(std::shared_ptr<const Scene>(std::shared_ptr<void>(), &scene), setup.transducer,
                    setup.image);
  NeedleView needle{make_pose({3e-3, 0, 11e-3}, {0.8, 0, 0.6}, Vec3::UnitY()), setup.needle,
                    Vec3(0, 0, 0.12)};
  std::vector<std::string> lines{"value"};
  for (const double side : {0.0, 0.3e-3}) {
    const Frame& f =
        renderer.render(make_pose({side, 0, -gap}, Vec3::UnitZ(), Vec3::UnitX()), needle);
    for (int line = 0; line < f.n_lines; line += 5)
      for (int i = line % 7; i < f.n_samples; i += 7) {
        const auto at = static_cast<std::size_t>(line * f.n_samples + i);
        lines.push_back(cell(static_cast<double>(f.decibel[at]), 2));
        if (!f.velocity.empty() && std::isfinite(f.velocity[at]))
          lines.push_back(cell(static_cast<double>(f.velocity[at]), 4));
      }
    for (int y = 0; y < f.height; y += 5)
      for (int x = 0; x < f.width; x += 5)
        lines.push_back(cell(f.image[static_cast<std::size_t>(y * f.width + x)], 0));
  }
  return lines;
}

TEST(Mutations, EveryParameterOfBeamAndImageIsNoticed) {
  const auto scene = block();
  std::vector<Subject<EchoSetup>> subjects;
  const auto add = [&](const std::string& name, const EchoSetup& setup, double gap = 0) {
    subjects.push_back({name, setup, [scene, gap](const EchoSetup& s) {
                          return picture_lines(*scene, s, gap);
                        }});
  };
  add("linear", small_picture());
  EchoSetup setup = small_picture();
  setup.transducer.radius = 40e-3;
  setup.transducer.transmit_focus = 12e-3;
  setup.image.tgc_limit_db = 12;
  setup.image.smoothing = 0.5;
  setup.image.persistence = 0.5;
  add("curved", setup);
  setup = small_picture();
  setup.transducer.steering = 0.15;
  setup.transducer.max_aperture = 5e-3;
  setup.image.doppler = true;
  setup.image.noise_db = -60;
  setup.needle.length = 12e-3;
  add("steered", setup);
  setup = small_picture();
  setup.image.compound_angles = 3;
  setup.image.texture = true;
  add("compound", setup);
  add("lifted", small_picture(), 5.1e-3);
  setup = small_picture();
  setup.image.look = Look::raw;
  add("raw", setup);
  auto mutations = try_mutations(subjects);
  expect_noticed("echo", mutations,
                 {{"image.n_threads", "the image does not depend on how many threads draw it"}});
}

}  // namespace
}  // namespace artus::test
