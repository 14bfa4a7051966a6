/* The interface of mikktspace.c, implemented by libdarboux_mikktspace: include this header and link the library instead of mikktspace.c.
 *
 * The results are the same, bit for bit (a NaN may have other bits), in less time. Names and layouts are those of Morten S. Mikkelsen's
 * mikktspace.h; the comments are part of Darboux: MIT or Apache-2.0, as you choose.
 *
 * Callbacks are called from the thread that calls genTangSpace, before it returns, in this order:
 *
 *   1. m_getNumFaces, once.
 *   2. m_getNumVerticesOfFace, once for each face in order. If no face has 3 or 4 corners, the function returns.
 *   3. For each face of 3 or 4 corners in order and each of its corners in order: m_getPosition, m_getNormal, m_getTexCoord, once each.
 *      If face 0 has another number of corners, m_getPosition is called for its corner 0 first, because the bounding box of the mesh starts
 *      there.
 *   4. For each of the same corners in the same order: m_setTSpace, then m_setTSpaceBasic, each once if it is set.
 *
 * (mikktspace.c reads each corner many times, and writes in the same order.) Callbacks may throw C++ exceptions, which reach the caller of
 * genTangSpace; they must not call longjmp. Several threads may call genTangSpace at the same time.
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

  /* The number of corners of face iFace. Faces of other than 3 or 4 corners are skipped. */
  int (*m_getNumVerticesOfFace)(const SMikkTSpaceContext *pContext, const int iFace);

  /* The position of corner iVert of face iFace: three floats. */
  void (*m_getPosition)(const SMikkTSpaceContext *pContext, float fvPosOut[], const int iFace, const int iVert);

  /* The normal of corner iVert of face iFace: three floats, unit length. */
  void (*m_getNormal)(const SMikkTSpaceContext *pContext, float fvNormOut[], const int iFace, const int iVert);

  /* The UV of corner iVert of face iFace: two floats. */
  void (*m_getTexCoord)(const SMikkTSpaceContext *pContext, float fvTexcOut[], const int iFace, const int iVert);

  /* Receives the tangent of a corner, three floats, and its sign: bitangent = fSign * cross(normal, fvTangent). These are not tangents
   * of vertices: corners of one vertex may differ, so the old index list is no longer valid. The fastest case: this is the only setter,
   * and all faces are triangles. */
  void (*m_setTSpaceBasic)(const SMikkTSpaceContext *pContext, const float fvTangent[], const float fSign, const int iFace,
                           const int iVert);

  /* Receives the whole frame of a corner: the directions of increasing u and v, perpendicular to the normal but not always to each
   * other; the world units per unit of u and per unit of v; and 1 where the UV map preserves orientation, 0 where it mirrors. */
  void (*m_setTSpace)(const SMikkTSpaceContext *pContext, const float fvTangent[], const float fvBiTangent[], const float fMagS,
                      const float fMagT, const tbool bIsOrientationPreserving, const int iFace, const int iVert);
} SMikkTSpaceInterface;

struct SMikkTSpaceContext {
  SMikkTSpaceInterface *m_pInterface;
  /* For the caller; not used by the library. */
  void *m_pUserData;
};

/* Computes the tangents of every corner, with a threshold of 180 degrees, which is what bakers use.
 *
 * Returns 1 on success. Returns 0 and calls no setter where no face has 3 or 4 corners, there are more than 2^30 - 1 corners, there is no
 * memory for the mesh, or pContext, m_pInterface or one of the five required functions is null. (mikktspace.c crashes where pContext,
 * m_pInterface or m_getNumFaces is null.) Running out of memory after the mesh was read aborts the program. */
tbool genTangSpaceDefault(const SMikkTSpaceContext *pContext);

/* As genTangSpaceDefault. fAngularThreshold: faces around a vertex share a frame while their directions of u and of v each differ by
 * less than this many degrees. */
tbool genTangSpace(const SMikkTSpaceContext *pContext, const float fAngularThreshold);

#ifdef __cplusplus
}
#endif

#endif /* MIKKTSPACE_H */
