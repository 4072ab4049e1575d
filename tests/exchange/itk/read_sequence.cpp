// SPDX-License-Identifier: AGPL-3.0-or-later
// What ITK reads from a sequence: a line of size and sum of the pixels, then each frame's
// transforms as the header has them.
#include <cstdio>
#include <exception>
#include <string>

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageRegionConstIterator.h>
#include <itkMetaDataObject.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using Image = itk::Image<unsigned char, 3>;
  const auto reader = itk::ImageFileReader<Image>::New();
  reader->SetFileName(argv[1]);
  try {
    reader->Update();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  const Image* image = reader->GetOutput();
  const auto size = image->GetLargestPossibleRegion().GetSize();
  unsigned long long sum = 0;
  itk::ImageRegionConstIterator<Image> pixel(image, image->GetLargestPossibleRegion());
  for (; !pixel.IsAtEnd(); ++pixel) sum = sum * 31 + pixel.Get();
  std::printf("%lu %lu %lu %llu\n", static_cast<unsigned long>(size[0]),
              static_cast<unsigned long>(size[1]), static_cast<unsigned long>(size[2]), sum);
  const itk::MetaDataDictionary& header = image->GetMetaDataDictionary();
  for (const std::string& key : header.GetKeys()) {
    std::string value;
    if (key.rfind("Seq_Frame", 0) == 0 && itk::ExposeMetaData(header, key, value))
      std::printf("%s = %s\n", key.c_str(), value.c_str());
  }
  return 0;
}
