-- The same with warnings of sectors.
BEGIN TRANSACTION;
CREATE TABLE job (
  id INTEGER PRIMARY KEY AUTOINCREMENT, request_id TEXT UNIQUE, manifest TEXT NOT NULL, preset TEXT NOT NULL,
  settings TEXT NOT NULL, overrides TEXT NOT NULL, region TEXT NOT NULL, state INTEGER NOT NULL, error TEXT NOT NULL,
  sectors_cached INTEGER NOT NULL, created INTEGER NOT NULL, ended INTEGER NOT NULL);
INSERT INTO "job" VALUES(5,'request','60be9861750facbfad8758254a2f76c0cfe78d54459a3bc187d49b1401fcd8e8','draft','{"bounces":2,"min_distance":7.0,"rays":99,"reach":64.0}','{"rays":"99"}','[0,0,1,1]',0,'',4,1000,0);
CREATE TABLE job_task (job INTEGER NOT NULL, task INTEGER NOT NULL, PRIMARY KEY (job, task)) WITHOUT ROWID;
INSERT INTO "job_task" VALUES(5,8);
INSERT INTO "job_task" VALUES(5,9);
CREATE TABLE map (manifest TEXT PRIMARY KEY, summary TEXT NOT NULL) WITHOUT ROWID;
INSERT INTO "map" VALUES('60be9861750facbfad8758254a2f76c0cfe78d54459a3bc187d49b1401fcd8e8','{"id":0,"content":"ed7002b439e9ac845f22357d822bac1444730fbdb6016d3ec9432297b9ec9f73","objects":3,"sectors":[[1,2]],"triangles":4,"warnings":["warned","twice"]}');
CREATE TABLE task (
  id INTEGER PRIMARY KEY, key TEXT UNIQUE NOT NULL, manifest TEXT NOT NULL, i INTEGER NOT NULL, j INTEGER NOT NULL,
  settings TEXT NOT NULL, state INTEGER NOT NULL, failed_attempts INTEGER NOT NULL, result TEXT NOT NULL,
  size INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL, error TEXT NOT NULL, warnings TEXT NOT NULL DEFAULT '');
INSERT INTO "task" VALUES(8,'0c49b4dd29afbbf600e87958576b1c7bf5bc45f015442d31c2590a70179b7c44','60be9861750facbfad8758254a2f76c0cfe78d54459a3bc187d49b1401fcd8e8',-3,5,'{"bounces":2,"min_distance":7.0,"rays":99,"reach":64.0}',1,2,'f6a214f7a5fcda0c2cee9660b7fc29f5649e3c68aad48e20e950137c98913a68',100,10,1099511627776,'','one
two');
INSERT INTO "task" VALUES(9,'80cfa3e7f28dde4df64436b652230aff28d7779116d1369c21ef2bbf37261d71','60be9861750facbfad8758254a2f76c0cfe78d54459a3bc187d49b1401fcd8e8',-2,5,'{"bounces":2,"min_distance":7.0,"rays":99,"reach":64.0}',0,0,'',0,0,0,'','');
COMMIT;
PRAGMA user_version=2;
