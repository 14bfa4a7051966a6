/* The interface of mikktspace.c, for libdarboux_mikktspace: include this header, link that library, and leave mikktspace.c out.
 *
 * The same names, layouts and results, bit for bit (a NaN may have other bits), in less time. Names and layouts are those of Morten S.
 * Mikkelsen's mikktspace.h; this text is Darboux's: MIT or Apache-2.0, as you choose.
 *
 * Callbacks are called from the thread that calls genTangSpace, before it returns, in this order:
 *
 *   1. m_getNumFaces, once.
 *   2. m_getNumVerticesOfFace, once for each face in order. If no face has 3 or 4 corners that is all.
 *   3. For each face of 3 or 4 corners in order and each of its corners in order: m_getPosition, m_getNormal, m_getTexCoord, once each.
 *      If face 0 has another number of corners, m_getPosition is called for its corner 0 before: the bounds of the mesh begin there.
 *   4. For each of the same corners in the same order: m_setTSpace, then m_setTSpaceBasic, each once if it is set.
 *
 * (mikktspace.c reads the same corners many times over, and writes in the same order.) Between 3 and 4 nothing is called. Callbacks may
 * throw C++ exceptions, which reach the caller of genTangSpace; they must not longjmp out. Several threads may call at once.
 */

#ifndef MIKKTSPACE_H
#define MIKKTSPACE_H

#ifdef __cplusplus
extern "C" {
#endif

/* 0 or 1. */
typedef int tbool;

typedef struct SMikkTSpaceContext SMikkTSpaceContext;

/* The caller's mesh: five functions that read it, which must all be set, and two that receive results, either of which may be null. */
typedef struct {
  /* The number of faces. */
  int (*m_getNumFaces)(const SMikkTSpaceContext *pContext);

  /* The number of corners of face iFace. Faces of other than 3 or 4 corners are passed over. */
  int (*m_getNumVerticesOfFace)(const SMikkTSpaceContext *pContext, const int iFace);

  /* The position of corner iVert of face iFace: three floats. */
  void (*m_getPosition)(const SMikkTSpaceContext *pContext, float fvPosOut[], const int iFace, const int iVert);

  /* Its normal: three floats, of unit length. */
  void (*m_getNormal)(const SMikkTSpaceContext *pContext, float fvNormOut[], const int iFace, const int iVert);

  /* Its UV: two floats. */
  void (*m_getTexCoord)(const SMikkTSpaceContext *pContext, float fvTexcOut[], const int iFace, const int iVert);

  /* Receives the tangent of a corner, three floats, and its sign: bitangent = fSign * cross(normal, fvTangent). These are not tangents
   * of vertices: corners of one vertex may differ, so an old index list cannot go on being used. Where this alone is set and all faces
   * are triangles, the result takes a small part of the time. */
  void (*m_setTSpaceBasic)(const SMikkTSpaceContext *pContext, const float fvTangent[], const float fSign, const int iFace,
                           const int iVert);

  /* Receives the whole frame of a corner: the directions of increasing u and v, perpendicular to the normal but not always to each
   * other; how many units of space one unit of u and of v takes; and 1 where the UV map keeps its orientation, 0 where it mirrors. */
  void (*m_setTSpace)(const SMikkTSpaceContext *pContext, const float fvTangent[], const float fvBiTangent[], const float fMagS,
                      const float fMagT, const tbool bIsOrientationPreserving, const int iFace, const int iVert);
} SMikkTSpaceInterface;

struct SMikkTSpaceContext {
  SMikkTSpaceInterface *m_pInterface;
  /* The caller's own. */
  void *m_pUserData;
};

/* Computes the tangents of every corner, with the threshold of 180 degrees that normal maps are baked with.
 *
 * Returns 1; or 0, without having written: no face has 3 or 4 corners, more than 2^30 - 1 corners, no memory for what is read, one of
 * the five functions that must be set is null, or pContext or m_pInterface is. (mikktspace.c crashes where pContext, m_pInterface or
 * m_getNumFaces is null.) Running out of memory after the mesh was read ends the program. */
tbool genTangSpaceDefault(const SMikkTSpaceContext *pContext);

/* As genTangSpaceDefault. fAngularThreshold: faces around a vertex share a frame while their directions of u and of v each differ by
 * less than this many degrees. */
tbool genTangSpace(const SMikkTSpaceContext *pContext, const float fAngularThreshold);

#ifdef __cplusplus
}
#endif

#endif /* MIKKTSPACE_H */
