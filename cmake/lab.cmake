# merlin-lab: what the models are made and measured with. Nothing of the product stands on it.

# Version 4 where there is one, else 3 (Debian 12's).
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
merlin_module(lab/scene PARTS . shape material object
  LINK merlin_mesh merlin_image merlin_optics)
merlin_module(lab/render LINK merlin_scene embree)
target_compile_definitions(merlin_render PRIVATE MERLIN_EMBREE=${embree_VERSION_MAJOR})
merlin_module(lab/train PARTS config samples .
  LINK merlin_nfps merlin_model merlin_render)
merlin_module(lab/eval PARTS metrics samples tables stereo paper
  LINK merlin_train merlin_photo_stereo)
merlin_module(lab/onnx LINK merlin_model)
merlin_module(lab/bench LINK merlin_eval)
merlin_program(merlin-lab lab/cli PARTS . eval LINK merlin_command merlin_bench merlin_onnx)
add_dependencies(merlin-lab merlin) # which its bench runs

# merlin-lab train --mpi, where there is an MPI.
find_package(MPI COMPONENTS C QUIET)
if(MPI_C_FOUND)
  add_library(merlin_mpi MODULE src/lab/mpi/mpi_ranks.c)
  set_target_properties(merlin_mpi PROPERTIES PREFIX "")
  target_include_directories(merlin_mpi PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(merlin_mpi PRIVATE MPI::MPI_C)
  add_dependencies(merlin-lab merlin_mpi)
endif()
