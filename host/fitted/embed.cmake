# Embeds the fitted models into topple_fitted.
set(MODEL_FILES ${CMAKE_CURRENT_BINARY_DIR}/fitted/model_files.cpp)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/fitted)
set(MODELS shell_model_json=${CMAKE_CURRENT_SOURCE_DIR}/fitted/shell.model.json
           joint_model_json=${CMAKE_CURRENT_SOURCE_DIR}/fitted/joint.model.json)
add_custom_command(
  OUTPUT ${MODEL_FILES}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fitted/embed_models.py ${MODEL_FILES} ${MODELS}
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/fitted/embed_models.py ${CMAKE_CURRENT_SOURCE_DIR}/fitted/shell.model.json
          ${CMAKE_CURRENT_SOURCE_DIR}/fitted/joint.model.json
  COMMENT "Embedding the fitted models"
  VERBATIM)
target_sources(topple_fitted PRIVATE ${MODEL_FILES})
